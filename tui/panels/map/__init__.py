"""The Map panel: where the robot is, and what is around it.

Only `panel` is used elsewhere, by the registry.
"""

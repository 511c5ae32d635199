"""The Head panel: where the head looks, and where it is commanded to look.

Only `panel` is used elsewhere, by the registry.
"""

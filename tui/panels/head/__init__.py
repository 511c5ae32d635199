"""The Head panel: where the head looks, and where it was told to look.

Only `panel` is used elsewhere, by the registry.
"""

"""The page that explains every key of the screen in front.

Only `screen` is used elsewhere, by the app.
"""

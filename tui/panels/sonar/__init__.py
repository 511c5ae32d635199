"""The Sonar panel: the distance to the nearest obstacle.

The registry uses `panel`; its `bar`, `bounds` and `words` also show distances elsewhere.
"""

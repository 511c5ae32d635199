"""The Voice panel: what human and robot say.

The registry uses `panel`, and the Flow tab `reading`.
"""

"""The Flow tab: what followed from an utterance, across nodes.

Messages and log lines become steps in `reading`, steps become chains in `book` and `chains`, and
chains become lines in `lines`, which `view` shows. Everything except `view` and `screen` is plain
data. Other rooms import only `screen` (for the app) and `actions` (for the names of its keys).
"""

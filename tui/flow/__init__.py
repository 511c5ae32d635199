"""The Flow tab: what followed from an utterance, across nodes, as a log of all of them with delays.

Messages and log lines become steps in `reading`, steps become chains in `chains`, and chains become
rows in `words`, which `screen` shows. Other rooms import only `screen` (for the app) and `actions`
(for the names of its keys).
"""

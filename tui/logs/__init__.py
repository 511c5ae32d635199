"""The Logs tab: the log of all nodes, and a list of those nodes.

The app creates `screen.LogsScreen` and the palette lists `actions`; nothing else here is meant for
use elsewhere.
"""

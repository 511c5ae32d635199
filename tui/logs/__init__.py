"""The tab of logs: what all nodes say, and the list of those nodes.

The app makes its `screen.LogsScreen`, the palette lists its `actions`; nothing else here is for
others.
"""

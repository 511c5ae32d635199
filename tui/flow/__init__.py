"""The tab of the flow: what followed from a word, across nodes.

Messages and log lines become steps in `reading`, steps chains in `book` and `chains`, chains lines
in `lines`, which `view` shows. All but `view` and `screen` is plain data. From outside: `screen`
for the app, nothing else.
"""

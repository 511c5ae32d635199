"""The list of lessons and of sessions that run: what may be opened, and what is in it.

From outside: `screen` for the app. What is asked or told before one opens stands in
`tui.lifecycle`, which opens it.
"""

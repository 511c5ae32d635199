"""The list of lessons, and what is asked or told before one opens.

From outside: `screen` for the app, and the dialogs `domain_taken`, `refused` and `strays` for
`tui.session`, which opens what was chosen.
"""

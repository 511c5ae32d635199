"""What a person sees: the app, its screens and widgets, built on Textual.

`live.run_screen` shows it on a terminal. Which folder may import which is a contract in
`pyproject.toml`: screens know the app as `frame.host.Host` alone, and none imports it.
"""

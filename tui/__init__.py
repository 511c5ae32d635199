"""The user interface: the app, its screens and its widgets, built on Textual.

`live.run_live` runs it on a terminal. Which folder may import which is a contract in
`pyproject.toml`: screens know the app only as `frame.host.Host`, and none of them imports it.
"""

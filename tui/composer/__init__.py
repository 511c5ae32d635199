"""The tab in which the JSON of an LLM is written, checked and sent.

`screen` joins the editor and the `verdict` on what is written with what came of what was sent,
which `tui.outcome` tells. From outside: `screen` for the app, `actions` for what names its keys.
"""

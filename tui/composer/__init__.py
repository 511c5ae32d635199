"""The Composer tab, in which the JSON of an LLM is written, checked and sent.

`screen` puts together the `draft` (editor, verdict, and a model's answers) and the outcome of what was
sent, which `tui.outcome` determines. Other rooms import only `screen` (for the app) and `actions`.
"""

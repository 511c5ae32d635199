"""The tab in which the JSON of an LLM is written, checked and sent.

`screen` joins the editor, the `verdict` on what is written, and the `outcome` of what was sent.
From outside: `screen` for the app, `actions` for what names its keys, and `outcome`,
`outcome_story` and `outcome_words`, by which the panel and the flow tell the same.
"""

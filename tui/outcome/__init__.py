"""The outcome of an LLM's JSON: accepted or refused, then drive, wheels and head, with delays.

The composer passes it what it has sent, a panel whatever arrives; the flow shows it in its own
lines. `trail` follows a message through the updates of the graph, `words` describes each event, and
`view` shows it. All modules may be used elsewhere.
"""

"""What came of JSON of an LLM: accepted or refused, then drive, wheels and head, with delays.

The composer tells it of what it has sent, a panel of whatever comes, the flow in its own lines.
Plain data of updates of the graph: `story` follows a message, `words` and `problem_words` say each
thing, `view` shows it. All of it may be imported from outside.
"""

"""What may be asked of the robot in words or JSON: the schema, and what is wrong with a text.

From outside: `schema`, the one door for an LLM's JSON, `problems`, and `brain`; `explain` and
`json_places` are theirs.
"""

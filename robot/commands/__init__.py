"""Commands to the robot in words or JSON: the schema, and the errors in a text.

Other rooms may import `schema`, the only entry point for an LLM's JSON, `problems`, and `brain`;
`json_places` is internal.
"""

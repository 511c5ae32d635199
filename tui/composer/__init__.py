"""The tab in which the JSON of an LLM is written, checked and sent."""

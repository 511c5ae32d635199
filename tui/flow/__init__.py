"""The tab of the flow: what followed from a word, across nodes."""

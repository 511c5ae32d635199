"""From messages to shapes: each reader takes a message as a tree (`graph.data.Value`).

What cannot be read is an `NotDrawnError`, whose text is a sentence for the user.
"""

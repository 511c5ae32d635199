"""A message as a folding tree of its fields: `tree.EchoTree` among the widgets of a screen.

Whoever shows a message or an answer uses the tree alone; `lines` and `values` are its inside.
"""

"""A message as a folding tree of its fields: `tree.EchoTree`, a widget for any screen.

Code that shows a message or an answer uses only the tree; `lines` is internal.
"""

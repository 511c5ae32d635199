"""The Lesson screen: what the step is about, what is judged of the learner's nodes, and hints.

`screen` is the screen, `actions` its keys; the rest serves them.
"""

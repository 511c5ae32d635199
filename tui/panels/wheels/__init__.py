"""The Wheels panel: how fast the wheels turn, and how they are steered.

The registry uses `panel`; driving with keys shows the same by `reading` and the words of `widget`.
"""

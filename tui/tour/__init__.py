"""The tour of the first start: a few pages that say what Deck is for and which keys matter.

`pages` is what they say, `screen` shows them.
"""

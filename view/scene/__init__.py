"""Messages as what Rerun draws: one reader for a kind of message, all of them without state.

Those that need what came before, such as the tree of frames, say so.
"""

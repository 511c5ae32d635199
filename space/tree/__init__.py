"""The tree of frames as somebody hears it, and what is wrong with it, in words with what to do."""

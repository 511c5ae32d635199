"""The tree of frames, what is wrong with it, and where one frame is in another."""

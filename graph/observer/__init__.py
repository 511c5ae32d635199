"""The observer: one node on a thread of its own that listens for the screen.

`asking` is the door for other threads; `station` owns all that lives on the observer's own.
"""

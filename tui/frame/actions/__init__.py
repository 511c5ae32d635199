"""The actions of every screen: those of the app, of a recording and of a replay.

Titles, keys, help and palette are made from them; to do one, call its `run`.
"""

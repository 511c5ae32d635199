"""What every screen of a session has around its body: title, bar of a replay, keys.

A new screen inherits `screen.DeckScreen`; what it needs of the app it finds in `host.Host`.
"""

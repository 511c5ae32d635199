"""What surrounds the body of every session screen: title, replay bar, keys.

A new screen inherits `screen.DeckScreen`; `host.Host` is what it may use of the app. Dialogs and
pages without a session use `title_bar` and `key_bar` alone.
"""

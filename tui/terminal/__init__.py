"""The terminal: what is written to it and how fast, and what is typed on it.

The app uses `driver.DeckDriver` as its driver, `key_queue` to keep keys in order, `stall_detector`
to detect stalls, and `stray_output` to keep the output of libraries off the screen. Widgets with
pictures ask `bandwidth` when to send the next one. Nothing here knows any screen of Deck.
"""

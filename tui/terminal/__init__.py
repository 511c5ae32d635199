"""The terminal itself: what is written to it, how fast, and what is typed on it.

The app runs on `driver.DeckDriver`, keeps keys in order by `key_queue`, watches for stalls by
`stall_detector` and keeps what libraries print off the screen by `stray_output`. Widgets that show
pictures ask `bandwidth` when the next may go. Nothing here knows a screen of Deck.
"""

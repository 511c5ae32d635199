"""What Deck publishes: once, at a rate, or for as long as a hand holds it.

The observer drives all three modules on its thread; others see `publications.Publication` and the
states of `dead_man_switch`.
"""

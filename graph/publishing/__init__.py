"""What Deck publishes: once, periodically, or while somebody holds a key.

The observer drives all three modules on its thread; others see `publications.Publication` and the
states of `dead_man_switch`.
"""

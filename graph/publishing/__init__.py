"""What Deck publishes: once, periodically, or while somebody holds a key.

The observer drives all three modules on its thread; other rooms use `dead_man_switch.HeldCommand`
and the limits of the rate in `publications`.
"""

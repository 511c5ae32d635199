"""What Deck publishes: once, periodically, or while somebody holds a key.

The observer drives it on its thread; other rooms use `dead_man_switch.HeldCommand` and the limits of the rate in
`outbox`.
"""

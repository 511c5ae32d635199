"""What nodes are made of: how they run and end, parameters, voice, the emergency stop.

For every node, and for the other folders here; it depends on none of them.
"""

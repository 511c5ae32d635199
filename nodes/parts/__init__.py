"""The building blocks of nodes: running and ending, parameters, logs, the emergency stop.

For every node, and for the other folders here; it depends on none of them.
"""

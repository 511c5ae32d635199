"""The gate of the safety node: what it sees, what it lets through, what it says.

For `safety_stop` alone.
"""

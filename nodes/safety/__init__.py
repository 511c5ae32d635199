"""The gate of the safety node: its sensors, the commands that it lets through, its messages.

For `safety_stop` only.
"""

"""Processes: finding them in the kernel's table, tying their lives, signals, stopping, cleanup.

Independent modules for the whole launcher; none of them knows about nodes or profiles.
"""

"""Processes: found in the kernel's table, tied together, signalled, ended, cleaned up after.

Tools for all of the launcher, each module by itself: none of them knows of nodes or profiles.
"""

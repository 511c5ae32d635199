"""Processes: found in the kernel's table, tied together, signalled, ended, cleaned up after."""

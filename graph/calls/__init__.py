"""Requests to other nodes, none of them blocking: services, goals, parameters.

The observer drives `services`, `goals`, `goals_seen` and `parameters` on its thread; from other
rooms only `parameters_file` and `timeouts`.
"""

"""Non-blocking requests to other nodes: services, goals, parameters.

The observer drives `services`, `goals`, `goals_seen` and `parameters` on its thread; other rooms
may import only `parameters_file` and `timeouts`.
"""

"""Non-blocking requests to other nodes: services, goals, parameters.

The observer drives all of it on its thread; other rooms may import only `parameters_file`.
"""

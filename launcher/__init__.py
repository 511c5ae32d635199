"""From a profile to running processes: the profile model, the supervisor and its control socket.

Other rooms may use `client` (start, attach, send requests, receive events), `profile` (load, list),
`status`, `events` and `errors` (the data they receive), `domain`, and the modules that look at this
machine: `runs`, `processes`, `serial_ports`, `rundir`, `private_files`. `supervisor`,
`spawn_server`, `control` and `logs` are internal.
"""

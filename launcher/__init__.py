"""From a profile to running processes: the profile model, the supervisor and its control socket.

From other rooms: `client` (start, attach, ask, listen), `profile` (load, list), `status`, `events`
and `errors` (what is told), `domain`, and what looks at this machine: `runs`, `processes`,
`serial_ports`, `rundir`. `supervisor`, `spawn_server`, `control` and `logs` are its own.
"""

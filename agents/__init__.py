"""Agents: programs that look at the robot and propose, and drive only with a person's consent.

`agents.server` speaks the Model Context Protocol, over `agents.stdio` or `agents.http`. `motion`,
`proposals`, `unasked_way` and `raw_access` decide what may be done at all, and `driving` carries it
out. No Textual here; rclpy only through `graph`.
"""

"""Profiles: from YAML to plain data that can be started, with the position of every error.

Other packages use `load.load_profile`, the only way to load a profile, `catalog` to list the
profiles, `text` and `driving` for what a profile says of itself, the names of the format (`panels`,
`devices`, `defaults`), and `device_variables` and `serial_choice` to look at devices before a
start. Fields of the format are declared in `model` alone; what the supervisor has to know of a node
is also in its input, `launcher.supervisor.plan`.
"""

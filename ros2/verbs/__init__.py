"""The commands, a file each, in which each verb is a function with `@verb`; see `ros2.verb`."""

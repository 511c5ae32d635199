"""The observer's own process: how it is started, what is said to it and by it, and its program.

The screen's end is `started`; `program` is what runs in the process, and `serving` what it does.
Between them is a stream socket, `wire`, with what `plain` makes of plain data, and updates as
`updates` shortens them. Nothing of rclpy is imported on the screen's side.
"""

"""What runs, as the screens see it: the session, the graph, and the messages that tell of both.

The screen reaches the supervisor and the ROS graph by the two ports (`ports`) alone. `feed.Feed`
is the only one who tells screens; they are known to it by the shape `feed.SessionScreen`.
"""

"""The session as the screens see it: its nodes, the graph, and the messages about both.

The screen reaches the supervisor and the ROS graph only through the two ports (`ports`). Only
`feed.Feed` sends messages to screens, which it knows as `feed.SessionScreen`. Every folder of the
screen may use the plain data here and the words for it; the command line uses `requests` and
`words`.
"""

"""The observer: one node in a process of its own that watches the graph for the screen.

Other rooms use `observer.Observer`, whose methods any thread may call, the classes of `requests`, and
`updates.merged`. In the `process`, `node` owns everything of ROS; nothing else may touch that.
"""

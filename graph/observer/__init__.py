"""The observer: one node in a process of its own that watches the graph for the screen.

Other rooms may import `observer.Observer`, whose methods any thread may call, what its process is
started ahead by, `process.started.start_ahead`, `requests.ObserverError`, and `merging`. On this
side `client` speaks to the process, and makes it anew. There, requests go through the queue of
`requests` to `loop`, where `node` owns everything of ROS; nothing else may touch that.
"""

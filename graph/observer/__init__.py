"""The observer: one node on a thread of its own that watches the graph for the screen.

Other rooms may import `observer.Observer`, whose methods any thread may call,
`requests.ObserverError`, and `interest.Interest`. Requests go through the queue of `requests` to
the observer's thread, where `node` owns everything of ROS; nothing else may touch that.
"""

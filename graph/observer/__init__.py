"""The observer: one node on a thread of its own that listens for the screen.

From outside: `observer.Observer`, whose methods any thread may call, `requests.ObserverError`, and
`interest.Interest`. What is asked goes through the queue of `requests` to the observer's thread,
where `node` owns all there is of ROS; nothing else may touch that.
"""

"""ROS domains: which one a profile runs in, who else is there, and who may hear it.

Any part of the launcher may use all of it; it depends on nothing of a session.
"""

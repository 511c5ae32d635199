"""ROS domains: which one a profile runs in, who else is in it, and who can reach it.

Any part of the launcher may use all of it; it does not depend on a session.
"""

"""Recording: a node of its own, raw messages, one rosbag2 directory.

From outside: `recorder` alone.
"""

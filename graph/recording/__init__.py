"""Recording: a node of its own, raw messages, one rosbag2 directory.

Other rooms may import only `recorder`.
"""

"""Recording: a node of its own, raw messages, one rosbag2 directory. Viewers take the same messages by a relay."""

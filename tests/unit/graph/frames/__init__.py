"""How frames are counted, kept and replayed, without ROS."""

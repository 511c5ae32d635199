"""ROS domains: which one a profile runs in, who else is there, and who may hear it."""

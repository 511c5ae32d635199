"""The ROS graph as plain data: topics, rates, samples and calls, with no widget in sight."""

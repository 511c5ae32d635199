"""What the frames of /tf cost."""

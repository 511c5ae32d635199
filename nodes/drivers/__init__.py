"""What real devices need: serial ports, cameras and sound that come and go."""

"""The tab of devices: drivers, and the frames on their wires."""

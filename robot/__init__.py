"""What the nodes and the screens share about the robot: pure functions and plain data.

Nothing here does input or output, and nothing here knows ROS: the formulas of the chassis,
the words and the JSON that drive it, the rules by which it stops. Nodes, screens and the command
line may use each folder as its own words say; names of topics and joints are in `topics`, `joints`.
"""

"""Knowledge about the robot that nodes and screens share: pure functions and plain data.

Nothing here does input or output or uses ROS: the formulas of the chassis, the words and the JSON
that drive it, the rules that stop it. Nodes, screens and the command line may import from each
folder what its docstring names; names of topics and joints are in `topics` and `joints`.
"""

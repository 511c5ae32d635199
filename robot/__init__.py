"""Knowledge about the robot that nodes and screens share: pure functions and plain data.

Nothing here does input or output or uses ROS: the formulas of the chassis, the words and the JSON
that drive it, the rules that stop it. Nodes, screens and the command line may import from each
folder what its docstring names, and all modules beside them: names in `topics` and `joints`, words
in `words`, formulas in `kinematics`, what the robot can do in `limits`, PCM in `sound`.
"""

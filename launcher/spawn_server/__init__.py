"""The spawn server: a child of the supervisor from which all nodes are forked.

It is the only part of the launcher that loads ROS; the others use it through `spawner`.
"""

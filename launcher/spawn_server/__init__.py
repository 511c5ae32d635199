"""The spawn server: a child of the supervisor from which all nodes are forked.

It is the only part of the launcher that loads ROS. The supervisor starts it by `start` and uses it
through `spawner`.
"""

"""The spawn server: a child of the supervisor from which every node is forked.

The only part of the launcher that loads ROS; all others talk to it through `spawner`.
"""

"""The emergency stop of any robot, and what a gate says: their topics, the record and the file of a stop.

Nodes obey it, screens and agents show it. Which topics move a robot is said here as well.
"""

"""The frames of /tf and /tf_static: every message is read, and what came of each frame is counted.

The observer feeds it with the messages of the robot, a replay with those of the recording.
"""

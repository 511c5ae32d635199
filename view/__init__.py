"""Viewers beside the screen: the robot in 3D by Rerun, and what is published for Foxglove.

Each runs in a process of its own, so that a heavy viewer never slows the screen, and only listens.
Whatever it opens is bound to this machine alone, and nothing is sent from it.
"""

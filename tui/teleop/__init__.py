"""Driving by keys, below the lesson: `widget.TeleopPanel` and the keys, routes and actions of it.

A screen on which one can drive offers what `actions.CanDrive` says.
"""

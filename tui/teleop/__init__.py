"""Driving with keys, below the lesson: `widget.TeleopPanel` with its keys, routes and actions.

A screen with this panel implements `actions.CanDrive`.
"""

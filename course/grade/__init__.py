"""Grading: the files of a folder against every step of a lesson, whatever those files do.

`grading.grade_all` has each folder judged by a process of its own (`__main__`, the examiner), in a
ROS domain, a run directory and on a copy of its own; `grades` is what comes of it, also as other
programs read it.
"""

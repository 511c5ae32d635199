"""Folders of lessons: finding one by number or name, and reading what is in it.

Others use `catalog` to find lessons and `lesson.LessonFolder`, what a folder holds.
"""

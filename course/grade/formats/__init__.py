"""Grades for other programs: each module writes one format, by its published description.

Others use `choice.writer_of`, which knows them all.
"""

"""Proving a lesson to its teacher: the starter fails, the solution passes, mistakes are caught.

Others use `proof.prove`, and `trial`, one run of a lesson on a folder of files.
"""

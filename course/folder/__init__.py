"""The learner's own folder of a lesson: making it, without ever losing what is there.

Others use `folder.new_folder`, `folder.new_node` and `programs.programs_for`.
"""

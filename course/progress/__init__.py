"""What the learner has done so far: a plain file in the course folder.

Others use `progress.load_progress`, `progress.noted` and `progress.Progress`.
"""

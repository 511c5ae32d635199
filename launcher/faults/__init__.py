"""What is wrong with a learner's own file: where, in which line, and what it means.

`source` looks at a file without running it, `explain` at an exception within its process, by the table and the
rules in `rules`; `crash` reads what a process has printed where it has told nothing itself, and says what a callback
that does not return waits for.
"""

CHECK_FIELDS = "ROS_PYTHON_CHECK_FIELDS"
"""The variable that has messages of Jazzy check the values of their fields, if it is 1."""

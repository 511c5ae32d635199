"""The course as something to do: lessons, the judge of a learner's nodes, progress, grading.

`lessons` finds and reads the folders of lessons, `judge` says of a running profile which steps it
passes (`results` is what it says; `judging` has one in a process of its own), `proof` proves a
lesson to its teacher, `folder` makes the learner's folder, `grade` gives points for it.
"""

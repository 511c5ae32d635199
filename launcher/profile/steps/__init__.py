"""The steps of a lesson: the part of a profile that says what a learner is to do, and how it shows.

`checks` has the kinds of checks, `model` the steps and the values that differ from run to run,
`expressions` what may stand in `${...}`. `course.judge` carries them out.
"""

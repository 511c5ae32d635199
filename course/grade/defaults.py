"""What `deck grade` has by default and by name, for code that does not import the grading."""

CLASSROOM50 = "classroom50"
FORMATS = ("json", "junit", "gradescope", CLASSROOM50, "csv")
WITHIN_S = 180.0
"""How long one folder may take."""

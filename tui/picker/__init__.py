"""The list of lessons, and what is asked or told before one opens."""

"""A robot that is not there, in a room that is not there: what it does and what it sees."""

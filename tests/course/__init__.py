"""Nodes that do what those of the course do, to be set in the place of Deck's."""

"""The wall: the panels that can be read across a room, and a large stop."""

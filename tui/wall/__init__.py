"""The wall: few numbers, large, and a large picture, for a projector or from across the room."""

"""The Wheels panel: how fast the wheels turn, and how they are steered."""

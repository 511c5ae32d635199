"""The panel of the wheels: how fast they turn, and how they are steered."""

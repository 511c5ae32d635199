"""The emergency stop on the screen: its state, who obeys it, what is done about it."""

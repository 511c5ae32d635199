"""The panel of the sonars: how far the next obstacle is."""

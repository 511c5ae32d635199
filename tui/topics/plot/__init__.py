"""Numbers of topics against time, drawn in braille."""

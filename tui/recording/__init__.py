"""Recording and playing back, from any tab."""

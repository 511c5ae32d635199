"""What a thinking robot costs: the way from a model, or from a voice, to the wheels."""

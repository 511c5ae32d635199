"""`deck view` and `deck foxglove`: viewers beside the screen."""

"""What a learner waits for while writing a node."""

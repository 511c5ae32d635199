"""The two recorders that `bench.recording` compares, and the load that both record."""

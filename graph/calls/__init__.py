"""What is asked of other nodes, never waited for: services, goals, parameters."""

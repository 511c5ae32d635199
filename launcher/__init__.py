"""From a profile to running processes: the profile model, the supervisor and its control socket."""

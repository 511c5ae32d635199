"""`deck check --preflight`: the devices of a profile before it drives."""

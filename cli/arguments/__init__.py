"""The arguments of `deck`: its commands, their options, and help in both languages."""

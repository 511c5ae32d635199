"""Text from outside, and how it may be shown: every room may import this one, it imports none."""

"""Tests of what the screen shows of agents, and of the answers to them."""

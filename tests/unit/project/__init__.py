"""Tests of the repository itself: rooms and contracts, README, Makefile, set-up, wheel."""

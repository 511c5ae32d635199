"""Tests of screens: pilot and snapshots."""

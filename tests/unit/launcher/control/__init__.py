"""Tests of the control protocol without a supervisor."""

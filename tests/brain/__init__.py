"""Tests of what thinks: real servers, real processes, models of random weights."""

"""Tests of the app as a whole: sessions, settings, languages, faults, hostile input."""

"""Hearing and speaking, measured."""

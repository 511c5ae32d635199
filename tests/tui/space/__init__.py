"""The Space screen."""

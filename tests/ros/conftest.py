"""Fixtures for tests with real nodes and real processes."""

from tests.ros.supervised import start

__all__ = ["start"]

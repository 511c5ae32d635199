"""Recorded bags: read, listed, described, and published into a domain again."""

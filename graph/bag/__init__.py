"""Recorded bags: reading, listing, describing them, and publishing them into a domain again.

Other rooms may import `files`, `listing`, `reading`, `publishing` and `errors`.
"""

"""Recorded bags: reading, listing, describing them, and publishing them into a domain again.

Other rooms may import `listing`, `reading`, `publishing` and `errors`; a replay also uses
`decoding`, `metadata` and `types`.
"""

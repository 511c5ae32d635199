"""Recorded bags: read, listed, described, and published into a domain again.

From outside: `listing`, `reading`, `publishing` and `errors`; a replay also takes `decoding`,
`metadata` and `types`.
"""

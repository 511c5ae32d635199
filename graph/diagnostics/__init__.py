"""/diagnostics of everybody: each status with the history of its level, as a tree by its name.

Others use `book.DiagnosticsBook` and the plain data of `reading` and `tree`.
"""

"""The output of nodes: read from their pipes, split into lines, kept in memory, written to files.

Other packages use `session_log` for a whole session, `reader` for a pipe, `ring` and `files`; `lines` is
internal.
"""

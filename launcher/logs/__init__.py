"""What nodes write: read from their pipes, cut into lines, kept, and put into files.

From outside: `session_log` for a whole session, `reader` for a pipe, `ring`, `files` and `folder`;
how a line is read, `lines`, `rcutils` and `text`, is its own.
"""

"""What nodes write: read from their pipes, cut into lines, kept, and put into files."""

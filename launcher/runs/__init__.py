"""What runs leave on disk for others to find: records, folders, and what was left behind."""

"""What runs leave on disk for others to find: records, folders, and what was left behind.

From outside: `shared_domain` and `strays` for whoever starts something, `run_folder` and `record`
for the supervisor, `found` for whoever looks for one.
"""

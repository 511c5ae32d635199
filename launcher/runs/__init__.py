"""Traces of runs that others can find: records, folders, and processes left behind.

Code that starts a profile uses `shared_domain` and `strays`, the supervisor `run_folder`, and code that
looks for sessions `record`.
"""

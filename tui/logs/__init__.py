"""The tab of logs, and the log view that other tabs have too."""

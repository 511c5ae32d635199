"""The first tab: the lesson's nodes, its panels, the log."""

"""The tab of topics: the table, one topic live, its plot, and publishing."""

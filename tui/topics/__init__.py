"""The tab of topics: the table, one topic live, its plot, and publishing.

The app makes its `screen.TopicsScreen`, the palette lists its `actions` and those of `publish`, and
other screens lead to a topic by its `table.choose`. Nothing else here is for others: the tree of a
message stands in `tui.echo`.
"""

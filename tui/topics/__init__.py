"""The Topics tab: the table, a live view of one topic, its plot, and publishing.

The app creates `screen.TopicsScreen`, the palette lists `actions` and those of `publish`, and other
screens link to a topic through `table.choose`. Nothing else here is meant for use elsewhere; the
tree of a message is in `tui.echo`.
"""

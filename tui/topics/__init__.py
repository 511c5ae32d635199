"""The Topics tab: the table, a live view of one topic, its plot, and publishing.

The app creates `screen.TopicsScreen`, and the palette lists `actions` and `actions_of_publish`; other
screens show a topic here by the method `show_topic`. Nothing else here is meant for use elsewhere;
the tree of a message is in `tui.echo`.
"""

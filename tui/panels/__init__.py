"""The panels of the Deck: each joins topics of the graph to a widget that draws them.

`registry` knows them by the names that profiles give them, `panel` is what each is, `shelf` shows
as many as have room. A panel's folder has the panel itself, the widget, which knows nothing of
topics, and `reading`, which makes plain values of messages. From outside: `registry`, `panel`,
`shelf`, and a panel's `reading` where another screen shows the same messages. A new panel is an
entry of `registry` and a module or folder here.
"""

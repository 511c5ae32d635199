"""The panels of the Deck: each connects topics of the graph to a widget that draws them.

`registry` maps the names in profiles to panels, `panel` is their base class, and `panel_grid` shows
as many as fit. A panel's folder has the panel itself, the widget, which knows nothing about topics,
and `reading`, which turns messages into plain values. Other rooms import only `registry`, `panel`,
`panel_grid`, and what a panel's own docstring names if they show the same messages. A new panel is
an entry in `registry` and a module or folder here.
"""

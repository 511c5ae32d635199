"""Lines that come in, in a view that follows the newest: filtered, searched, copied, written down.

Screens that show such lines make a `LogPane` around a `LogView` (`pane`, `view`), bind subclasses
of the actions in `actions`, and choose what is shown by a `LogFilter` (`filter`). `index.folded`
and `rows.clock` fold a text and tell a time for others too. The rest is the view's own.
"""

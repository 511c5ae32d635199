"""Incoming lines in a view that follows the newest: filtered, searched, copied, saved.

Screens that show such lines create a `LogPane` around a `LogView` (`pane`, `view`), bind subclasses
of the actions in `actions`, and choose what is shown with a `LogFilter` (`filter`). `index.folded`
and `rows.clock`, which wrap a text and format a time, are used elsewhere too. Everything else is
internal.
"""

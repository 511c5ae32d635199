"""Incoming lines in a view that follows the newest: filtered, searched, copied, saved.

Screens that show such lines create a `LogPane` around a `LogView` (`pane`, `view`), bind actions that
call it, and choose what is shown with a `LogFilter` (`index`). `index.folded` and `rows.clock`, which
wrap a text and format a time, are used elsewhere too. Everything else is internal.
"""

"""The panels of the Deck, a file each: what it reads, how it draws that, and from which topics.

`panel` is their base class, `panel_grid` shows as many as fit; they draw on `tui.widgets.canvas`. Their names, titles
and topics are in `robot.announced`. Other rooms import from a panel only what shows the same messages.
"""

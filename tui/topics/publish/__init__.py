"""Publishing from the Topics screen: `dialog.PublishDialog`, and `actions` for the palette."""

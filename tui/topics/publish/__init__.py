"""Publishing from the topics: `dialog.PublishDialog`, and `actions` for the palette."""

"""The page that explains every key of the screen in front."""

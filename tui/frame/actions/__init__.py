"""What can be done on every screen: the app's own actions, those of a recording and of a replay."""

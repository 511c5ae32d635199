"""The actions of every screen: those of the app, of a recording and of a replay."""

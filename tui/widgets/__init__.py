"""Widgets used by several screens: they take plain data through methods and post messages.

The texts that go with them are in `words`, `trouble` and `node_words`. Every screen and panel may
import these; they know no screen and no app, and of the other folders only the fault handler and
the pace of pictures. A widget used by only one screen is in the folder of that screen.
"""

"""Widgets that two screens or more share: plain data in by methods, Textual messages out.

And the words that go with them (`words`, `trouble`, `node_words`). Every screen and panel may
import these; they know no screen and no app; of the rest only who takes faults and the pace of
pictures. What one screen alone uses stands in its folder.
"""

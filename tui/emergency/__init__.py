"""The emergency stop on the screen: its state, which nodes obey it, and how it is carried out.

`control.EmergencyControl` engages and releases it; `state.Emergency` is plain data that others may
read, and `messages.EmergencyChanged` reports changes to screens. `words` and `gate` say how things
stand, for titles and panels. There are no widgets here.
"""

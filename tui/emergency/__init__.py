"""The emergency stop on the screen: its state, who obeys it, what is done about it.

`control.EmergencyControl` engages and releases; `state.Emergency` is plain data that others may
read, and `messages.EmergencyChanged` tells screens of it. No widget is in here.
"""

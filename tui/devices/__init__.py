"""The Devices tab: what each driver reports about itself, and the frames on its serial line.

The app creates `screen.DevicesScreen` and the palette lists `actions`; nothing else here is meant
for use elsewhere.
"""

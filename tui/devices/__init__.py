"""The tab of devices: what each driver says of itself, and the frames on its wire.

The app makes its `screen.DevicesScreen`, the palette lists its `actions`; nothing else here is for
others.
"""

"""What thinks, hears and speaks: language models, their servers, speech; no ROS, no screen.

Everything that may leave this machine leaves it from here, and only to the server that the user's
settings name.
"""

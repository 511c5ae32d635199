"""Print the prefix under which pip installed the ROS wheels that this build uses."""

from importlib.metadata import files

CONFIG = "rosidl_cmakeConfig.cmake"

config = next(path for path in files("ros-rosidl-cmake") or () if path.name == CONFIG)
print(config.locate().resolve().parents[3].as_posix())

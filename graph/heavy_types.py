"""The types of messages that are most of a recording wherever they are published."""

from __future__ import annotations

IMAGE = "sensor_msgs/msg/Image"
COMPRESSED_IMAGE = "sensor_msgs/msg/CompressedImage"
POINT_CLOUD = "sensor_msgs/msg/PointCloud2"
IMAGES = frozenset({IMAGE, COMPRESSED_IMAGE})
HEAVY_TYPES = (IMAGE, COMPRESSED_IMAGE, POINT_CLOUD)

"""Moving points, vectors and poses of geometry_msgs into another frame.

Importing it is what lets `Buffer.transform` move them. The code is Deck's own; where a ROS brings
the package of this name, Python finds it first.
"""

from tf2_geometry_msgs.moving import (
    do_transform_point,
    do_transform_pose,
    do_transform_pose_stamped,
    do_transform_vector3,
)

__all__ = ["do_transform_point", "do_transform_pose", "do_transform_pose_stamped", "do_transform_vector3"]

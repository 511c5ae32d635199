"""Images of ROS as arrays of OpenCV, and back, for a ROS that comes without its cv_bridge.

The names, the arguments and the refusals are those of the package of the same name; the code is
Deck's own. Where a ROS brings that package, Python finds it first.
"""

from cv_bridge.bridge import CvBridge
from cv_bridge.colours import CvBridgeError

__all__ = ["CvBridge", "CvBridgeError"]

"""Python packages of ROS 1, and those of ROS 2 that Deck does not bring."""

from __future__ import annotations

OF_ROS1 = (
    "rospy", "roslib", "rosbag", "tf", "actionlib", "roslaunch", "dynamic_reconfigure",
    "tf_conversions", "moveit_commander", "ros_numpy", "rosgraph", "rosmsg", "rosnode", "rosparam",
    "rosserial_msgs", "rosserial_python", "rosservice", "rostopic",
)  # fmt: skip
OF_ROS = (
    "action_tutorials_interfaces", "action_tutorials_py", "actionlib_msgs", "ament_copyright",
    "ament_flake8", "ament_index_python", "ament_pep257", "apriltag_msgs", "audio_common_msgs",
    "camera_calibration", "can_msgs", "cartographer_ros_msgs", "control_msgs", "controller_manager",
    "controller_manager_msgs", "demo_nodes_py", "depthai_ros_msgs", "diagnostic_aggregator",
    "diagnostic_updater", "domain_coordinator", "dwb_msgs", "event_camera_msgs",
    "examples_rclpy_executors", "examples_rclpy_minimal_action_client",
    "examples_rclpy_minimal_action_server", "examples_rclpy_minimal_client",
    "examples_rclpy_minimal_publisher", "examples_rclpy_minimal_service",
    "examples_rclpy_minimal_subscriber", "foxglove_msgs", "gazebo_msgs", "geographic_msgs",
    "gps_msgs", "grid_map_msgs", "image_geometry", "image_transport", "irobot_create_msgs",
    "joint_state_publisher", "laser_geometry", "launch", "launch_pytest", "launch_ros",
    "launch_testing", "launch_xml", "launch_yaml", "map_msgs", "mavros", "mavros_msgs",
    "message_filters", "micro_ros_msgs", "moveit", "moveit_configs_utils", "moveit_msgs",
    "nav2_common", "nav2_msgs", "nav2_simple_commander", "nav_2d_msgs", "nmea_msgs",
    "object_recognition_msgs", "octomap_msgs", "pcl_msgs", "py_trees", "py_trees_ros", "PyKDL",
    "python_qt_binding", "qt_gui", "radar_msgs", "rclpy_message_converter",
    "realsense2_camera_msgs", "rmf_task_msgs", "robot_localization", "ros2action", "ros2bag",
    "ros2cli", "ros2doctor", "ros2interface", "ros2launch", "ros2lifecycle", "ros2node",
    "ros2param", "ros2pkg", "ros2run", "ros2service", "ros2topic", "ros_gz_interfaces", "rosapi",
    "rosapi_msgs", "rosbag2_interfaces", "rosbag2_py", "rosbridge_library", "rosbridge_msgs",
    "rosidl_runtime_py", "rqt", "rqt_graph", "rqt_gui", "rqt_gui_py", "rqt_plot", "rtabmap_msgs",
    "sensor_msgs_py", "slam_toolbox", "sros2", "statistics_msgs", "teleop_twist_keyboard",
    "test_msgs", "tf2_kdl", "tf2_sensor_msgs", "tf2_tools", "tf_transformations",
    "tracetools_trace", "turtle_tf2_py", "turtlebot3_msgs", "turtlebot4_msgs", "turtlesim",
    "ublox_msgs", "ur_msgs", "urdf_parser_py", "velodyne_msgs", "vision_msgs", "webots_ros2_driver",
    "webots_ros2_msgs", "xacro",
)  # fmt: skip
"""Packages of ROS that Deck does not bring."""
_PACKAGED = {
    "moveit": "moveit-py", "PyKDL": "python-orocos-kdl-vendor", "urdf_parser_py": "urdfdom-py",
}  # fmt: skip
"""Where it is not called as what is imported."""


def apt_name(name: str) -> str:
    """Return what follows `ros-jazzy-` in the name of the package with this module."""
    return _PACKAGED.get(name, name.replace("_", "-"))

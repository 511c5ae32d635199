"""The viewer in 3D beside the screen: its process, and the dialog that says where it is."""

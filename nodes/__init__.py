"""The lesson nodes and the hardware drivers, one file each, each runnable alone."""

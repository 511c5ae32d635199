"""The verbs, one file each: `SUMMARY`, `arguments(parser)` and `main(args)`; see `ros2.table`."""

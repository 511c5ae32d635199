"""From shapes in space to the cells of a terminal: paints, shapes, a camera, and a raster."""

"""Numbers of messages against time, drawn in cells: `plot.TopicPlot` shows `field.PlotField`s."""

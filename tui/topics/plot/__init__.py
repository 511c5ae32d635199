"""Numbers of messages against time, drawn in cells: `plot.TopicPlot`, of `field.PlotField`s."""

"""Numbers of messages against time, drawn in cells: `plot.TopicPlot` shows `field.PlotField`s.

For the Topics tab only.
"""

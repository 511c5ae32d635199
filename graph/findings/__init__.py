"""What is wrong with a graph: pure functions from a `graph.data.GraphUpdate` to findings in words.

Others use `examining.examine` for one moment, `lasting.LastingFindings` over time, and the plain
data of `finding`.
"""

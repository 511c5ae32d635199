"""What is wrong with a graph: from a `graph.data.GraphUpdate` to findings in words."""

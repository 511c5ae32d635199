"""The tab of the graph: nodes, services, actions, types, and what can be asked of them."""

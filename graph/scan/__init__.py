"""The graph as the middleware of this process knows it: nodes, endpoints, who talks to whom."""

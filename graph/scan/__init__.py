"""The graph as the middleware of this process knows it: nodes, endpoints, who talks to whom.

From outside: `scan.scan`, and `endpoints` for one topic; only the thread of the node may call them.
"""

"""The graph as the middleware of this process knows it: nodes, endpoints, who talks to whom.

Other rooms may use `scan.scan`, and `endpoints` for one topic, on the node's thread only.
"""

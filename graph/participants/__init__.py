"""Who is in the domain, and who of them has told all about its nodes and their endpoints.

Every participant publishes on the DDS topic `ros_discovery_info` which nodes it has, and by which
endpoints each of them speaks. The middleware makes names of nodes from it, and keeps silent about
endpoints that were announced there and have not been found yet.
"""

"""What is normal in the graph of Deck's robot, for `graph.findings`."""

from __future__ import annotations

from graph.findings.finding import GraphNorms
from robot.safety.moving_topics import SOLE, moves
from robot.topics import MAY_WAIT, OF_MANY

NORMS = GraphNorms(moves, SOLE, OF_MANY, MAY_WAIT)

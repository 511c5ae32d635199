"""What is normal in the graph of Deck's robot, for `graph.findings`."""

from __future__ import annotations

from graph.findings.finding import GraphNorms
from robot.safety.moving_topics import SOLE, moves
from robot.topics import OF_MANY, SPOKEN_BY_PEOPLE

NORMS = GraphNorms(moves, SOLE, OF_MANY, SPOKEN_BY_PEOPLE)

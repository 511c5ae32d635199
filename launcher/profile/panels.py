"""The names of panels that a profile may list: part of the file format, defined here.

`tui.panels.registry` maps these names to the panels and the topics they show.
"""

from __future__ import annotations

from typing import Literal

Panel = Literal["sonar", "wheels", "map", "camera", "head", "voice", "brain", "composer"]

"""The names of panels that a profile may list: part of the file format, defined here.

What a panel is made of, and which topics it shows, `tui.panels.registry` knows for these names.
"""

from __future__ import annotations

from typing import Literal

Panel = Literal["sonar", "wheels", "map", "camera", "head", "voice", "composer"]

"""The names of panels that a profile may list: words of the file's format, known here first.

What a panel is made of, and which topics it shows, `tui.panels.registry` knows for these names.
"""

from __future__ import annotations

from typing import Literal

Panel = Literal["sonar", "wheels", "map", "camera", "head", "voice", "composer"]

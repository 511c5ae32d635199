"""Numbers of a sentence as its language writes them: 0.36 in English, 0,36 in Russian."""

from __future__ import annotations

import string
from typing import Any


class _Russian(string.Formatter):
    """Writes a float with a decimal comma; what is text already, such as what one types, stays."""

    def format_field(self, value: Any, format_spec: str) -> str:  # noqa: ANN401 - as in `string`
        written: str = super().format_field(value, format_spec)
        return written.replace(".", ",") if isinstance(value, float) else written


_RUSSIAN = _Russian()


def with_comma(template: str, **values: object) -> str:
    """Fill a Russian template in the manner of `str.format`."""
    return _RUSSIAN.format(template, **values)

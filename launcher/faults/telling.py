"""How a learner's process tells the supervisor what it knows, among the lines that it prints.

A line of standard error that is an OSC sequence of a terminal's, which shows nothing, with JSON in
it. Whoever prints one says something about a program of their own.
"""

from __future__ import annotations

import json
from typing import Any

from launcher.status import NodeFault
from text.nested import read_json
from text.packing import pack_text, unpack_text

BEGIN = b"\x1b]deck;"
END = b"\x07"
FAULT = "fault"
"""The key of a `NodeFault`."""
CALLBACK = "callback"
"""The key of what `launcher.callback_watch` has seen."""


def pack_fault(fault: NodeFault) -> dict[str, Any]:
    """Return a fault as JSON."""
    said = {"exception": pack_text(fault.exception), "meaning": pack_text(fault.meaning)}
    return {**vars(fault), **said}


def unpack_fault(fields: dict[str, Any] | None) -> NodeFault | None:
    """Return the fault that `pack_fault` was given."""
    if fields is None:
        return None
    said = {name: unpack_text(fields[name]) for name in ("exception", "meaning")}
    return NodeFault(**{**fields, **said})


def line_of(fault: NodeFault) -> bytes:
    """Return the line that tells a fault."""
    text = json.dumps({FAULT: pack_fault(fault)}, separators=(",", ":"))
    return BEGIN + text.encode() + END + b"\n"


def told_in(data: bytes) -> tuple[bytes, dict[str, Any] | None]:
    """Return what stands in a line before such a sequence, and what the sequence tells.

    None: the line has no such sequence. An empty dictionary: it has one that cannot be read.
    """
    before, found, after = data.partition(BEGIN)
    if not found:
        return data, None
    try:
        told = read_json(after.partition(END)[0])
    except (ValueError, RecursionError):
        return before, {}
    return before, told if isinstance(told, dict) else {}


def fault_in(told: dict[str, Any]) -> NodeFault | None:
    """Return the fault that a process has told, None if there is none, or no proper one."""
    fields = told.get(FAULT)
    if not isinstance(fields, dict):
        return None
    try:
        return unpack_fault(fields)
    except (AttributeError, KeyError, TypeError, ValueError):
        return None

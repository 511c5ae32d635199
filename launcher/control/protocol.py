"""The protocol of the control socket: one JSON object per line, both ways, versioned.

The supervisor speaks first: `{"deck": VERSION, "session": ..., "nodes": [...], "strays": [...],
"agents": ..., "unguarded": false}`.
A client answers `{"deck": VERSION}`, then sends requests such as `{"id": 1, "op": "start", "nodes":
["sonar"]}`. It receives `{"reply": 1, "result": ...}` or `{"reply": 1, "error": {...}}`, and in
between events: `{"event": "status" | "log" | "strays" | "agents" | "unguarded" | "closed", ...}`.
`unguarded` tells that the supervisor has lost its guardian.

`{"id": 1, "op": "emergency_stop", "said_ns": ...}` gives the robot an emergency stop, and
`emergency_release` releases those from before it, by the file that the nodes watch: no middleware
is needed. `said_ns` is when it was said, unix time; without it, that is when the request arrives.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from launcher.consent import Agent, AgentRules, Agents, Approval, Question
from launcher.faults.telling import pack_fault, unpack_fault
from launcher.status import NodeState, NodeStatus, SessionInfo, Stray, Who
from text.packing import pack_text, unpack_text

if TYPE_CHECKING:
    from collections.abc import Mapping

VERSION = 4

MAX_REQUEST_BYTES = 1 << 20
"""Longest line from a client; a longer one is an error."""
MAX_MESSAGE_BYTES = 64 << 20
"""Longest line that the supervisor can send."""
MAX_HISTORY_LINES = 20_000
MAX_HISTORY_CHARS = 8 << 20
"""Most characters of a history; of a longer one only the newest lines are sent."""


def encode(message: Mapping[str, Any]) -> bytes:
    """Return a message as one line; file names in it may contain lone surrogates."""
    text = json.dumps(message, ensure_ascii=False, separators=(",", ":"))
    return text.encode("utf-8", "surrogatepass") + b"\n"


def pack_status(status: NodeStatus) -> dict[str, Any]:
    """Return a node's status as JSON."""
    fault = None if status.fault is None else pack_fault(status.fault)
    return {**vars(status), "detail": pack_text(status.detail), "fault": fault}


def unpack_status(fields: dict[str, Any]) -> NodeStatus:
    """Return the status that `pack_status` was given."""
    return NodeStatus(
        **{
            **fields,
            "state": NodeState(fields["state"]),
            "detail": unpack_text(fields["detail"]),
            "needs": tuple(fields["needs"]),
            "fault": unpack_fault(fields["fault"]),
        }
    )


def pack_session(session: SessionInfo) -> dict[str, Any]:
    """Return the session as JSON."""
    return asdict(session)


def unpack_session(fields: dict[str, Any]) -> SessionInfo:
    """Return the session that `pack_session` was given."""
    discovery = fields["discovery"]
    return SessionInfo(
        **{
            **fields,
            "panels": tuple(fields["panels"]),
            "discovery": discovery if isinstance(discovery, str) else tuple(discovery),
            "started_by": Who(**fields["started_by"]),
            # A session that an older Deck has started has none.
            "agents": unpack_rules(fields.get("agents", {})),
        }
    )


def unpack_rules(fields: dict[str, Any]) -> AgentRules:
    """Return the rules that `dataclasses.asdict` was given; what is missing is as by default."""
    lists: dict[str, Any] = {name: tuple(fields[name]) for name in ("publish", "call") if name in fields}
    return AgentRules(**{**fields, **lists})


def pack_agents(agents: Agents) -> dict[str, Any]:
    """Return agents and their questions as JSON."""
    questions = [{**vars(one), "lines": [pack_text(line) for line in one.lines]} for one in agents.questions]
    return {"connected": [vars(one) for one in agents.connected], "questions": questions}


def unpack_agents(fields: dict[str, Any]) -> Agents:
    """Return the agents that `pack_agents` was given."""
    connected = [Agent(**{**one, "approval": Approval(one["approval"])}) for one in fields["connected"]]
    questions = [Question(**{**one, "lines": tuple(map(unpack_text, one["lines"]))}) for one in fields["questions"]]
    return Agents(tuple(connected), tuple(questions))


def pack_stray(stray: Stray) -> dict[str, Any]:
    """Return a stray as JSON."""
    return asdict(stray)


def unpack_stray(fields: dict[str, Any]) -> Stray:
    """Return the stray that `pack_stray` was given.

    Raises:
        TypeError, ValueError: if it is anything else.
    """
    return Stray(
        pid=int(fields["pid"]),
        started_s=float(fields["started_s"]),
        node=str(fields["node"]),
        command=str(fields["command"]),
        run_id=str(fields["run_id"]),
    )

"""What nodes that ask a model have said of themselves on /brain_state."""

from __future__ import annotations

from graph.data import Sample
from tests.tui.recorded import sample

BRAIN_STATE, TYPE = "/brain_state", "diagnostic_msgs/msg/DiagnosticArray"
BUDGET = {"calls_last_minute": "3", "calls_per_minute": "20", "tokens": "498", "tokens_per_session": "200000"}
USAGE = {
    "input_tokens": "412",
    "output_tokens": "86",
    "first_token_s": "0.310",
    "total_s": "1.204",
    "cost": "0.000113",
    "currency": "USD",
}


def brain_state(message: str = "has answered; m-1", level: int = 0, node: str = "ai_brain", **values: str) -> Sample:
    """Return one report; `values` replaces some of a model's that has answered."""
    given = {"backend": "llm", "fault": "", "model": "m-1", **BUDGET, **USAGE, **values}
    pairs = [{"key": key, "value": value} for key, value in given.items() if value != "-"]
    status = [{"level": level, "name": node, "hardware_id": "", "message": message, "values": pairs}]
    return sample(BRAIN_STATE, TYPE, {"header": {}, "status": status})


def no_answer_yet() -> Sample:
    """Return the report of a brain that waits for its first voice."""
    return brain_state("waits for a voice; m-1", 0, "ai_brain", **dict.fromkeys(USAGE, "-"))

"""What a supervisor tells of a node, as it arrives at the other end."""

from __future__ import annotations

import json
from dataclasses import replace

from launcher.consent import DEFAULT_RULES, AgentRules
from launcher.control.protocol import (
    encode,
    pack_session,
    pack_status,
    unpack_session,
    unpack_status,
)
from launcher.status import NodeFault, NodeState, NodeStatus, SessionInfo
from text.i18n import localized, set_language
from text.sentences import say


def test_all_words_of_a_fault_can_be_translated_at_the_other_end() -> None:
    fault = NodeFault(
        "warning",
        "/course/hello_node.py",
        26,
        exception=say("the program came to its end"),
        meaning=say("the program came to its end"),
    )
    status = NodeStatus("hello", "hello_node.py", NodeState.EXITED, fault=fault)
    told = unpack_status(json.loads(encode(pack_status(status))))
    assert told.fault == fault
    set_language("ru")
    try:
        assert localized(told.fault.exception) == "программа дошла до конца"
        assert localized(told.fault.meaning) == "программа дошла до конца"
    finally:
        set_language("en")


def test_a_session_of_an_older_deck_has_the_rules_for_agents_by_default() -> None:
    session = SessionInfo("1-2", "/robot.yaml", "robot")
    older = json.loads(encode(pack_session(session)))
    del older["agents"]
    assert unpack_session(older).agents == DEFAULT_RULES
    ruled = replace(session, agents=AgentRules(0.1, 0.5, 2.0, ("/lamp",), ("/lamp_on",)))
    assert unpack_session(json.loads(encode(pack_session(ruled)))) == ruled

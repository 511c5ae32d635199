"""`deck doctor --graph` and `deck diagnostics` in a domain whose nodes others have started."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from std_msgs.msg import Float32
from std_srvs.srv import Trigger

from tests.deck_process import DeckProcess, deck
from tests.hostile_text import WORST, harm_in
from tests.ros.peer import Peer

pytestmark = pytest.mark.nightly


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


@pytest.fixture
def peer(ros_domain: int) -> Iterator[Peer]:
    with Peer(ros_domain, "guard") as peer:
        yield peer


def test_findings_have_a_place_and_a_mend_and_make_the_exit_code_1(
    peer: Peer, ros_domain: int
) -> None:
    peer.publisher("/sensor/sonar_front", Float32)
    peer.hear("/sensor/sonar_frnt", Float32)
    peer.node.create_client(Trigger, "/nobody")
    told, english, russian = (
        DeckProcess("doctor", "--graph", "--domain", str(ros_domain), *more)
        for more in (["--json"], [], ["--lang", "ru"])
    )
    assert [told.finish(), english.finish(), russian.finish()] == [1, 1, 1]
    findings = json.loads("\n".join(told.lines))
    assert [(one["key"], one["level"], one["place"]) for one in findings] == [
        ("graph.unserved", "fail", {"kind": "service", "name": "/nobody"}),
        ("graph.near-name", "fail", {"kind": "topic", "name": "/sensor/sonar_frnt"}),
    ]
    assert all(one["text"] and one["mend"] for one in findings)
    assert {name for one in findings for name in one["nodes"]} == {"/guard"}
    assert english.lines[2].startswith("FAIL  topic /sensor/sonar_frnt: Nobody publishes it")
    assert english.lines[3].strip().startswith("-> Let both use one name")
    assert english.lines[4].startswith(f"domain {ros_domain}: nodes: 1")
    assert english.lines[4].endswith("findings: 2")
    assert russian.lines[4].endswith("замечаний: 2")


def test_a_graph_without_findings_in_which_nobody_reports_anything(
    peer: Peer, ros_domain: int
) -> None:
    peer.publisher("/diagnostics", DiagnosticArray)
    doctor, reports = DeckProcess("doctor", "--graph"), DeckProcess("diagnostics")
    assert [doctor.finish(), reports.finish()] == [0, 2]
    (line,) = doctor.lines
    assert line.startswith(f"domain {ros_domain}: nodes: 1, topics: 1,")
    assert line.endswith("no findings")
    assert reports.lines == []
    assert "nobody has said anything on /diagnostics" in "\n".join(reports.errors)


def test_an_empty_domain_is_no_healthy_one(ros_domain: int) -> None:
    doctor, reports = DeckProcess("doctor", "--graph", "--json"), DeckProcess("diagnostics")
    for run in (doctor, reports):
        assert (run.finish(), run.lines) == (2, [])
        assert f"no node was found in domain {ros_domain}" in "\n".join(run.errors)


def diagnostics(*told: DiagnosticStatus) -> DiagnosticArray:
    return DiagnosticArray(status=list(told))


def status(name: str, level: int, message: str, **values: str) -> DiagnosticStatus:
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(name=name, level=bytes([level]), message=message, values=pairs)


def test_diagnostics_are_a_tree_the_worst_first(peer: Peer) -> None:
    said = diagnostics(
        status("battery", 0, "7.4 V"),
        status("/arm/gripper: motor", 77, "hot", temperature="nan"),
        status(WORST.replace("\0", ""), 1, WORST.replace("\0", "")),
    )
    with peer.saying("/diagnostics", said):
        told, text = DeckProcess("diagnostics", "--json"), DeckProcess("diagnostics")
        assert [told.finish(), text.finish()] == [1, 1]
    first, *_, last = json.loads("\n".join(told.lines))
    assert (first["path"], first["level"]) == (["arm", "gripper", "motor"], "ERROR")
    assert first["values"] == {"temperature": "nan"}
    assert (last["name"], last["level"], last["message"]) == ("battery", "OK", "7.4 V")
    assert [line.split() for line in text.lines[:3]] == [
        ["ERROR", "arm"],
        ["ERROR", "gripper"],
        ["ERROR", "motor", "hot"],
    ]
    assert text.lines[-1].split() == ["ok", "battery", "7.4", "V"]
    assert not harm_in("\n".join(text.lines).encode())


def test_diagnostics_that_are_all_well_make_the_exit_code_0(peer: Peer) -> None:
    with peer.saying("/diagnostics", diagnostics(status("battery", 0, "7.4 V"))):
        run = deck("diagnostics", "--for", "1", "--lang", "ru")
    assert run.process.returncode == 0
    assert [line.split() for line in run.lines] == [["ок", "battery", "7.4", "V"]]

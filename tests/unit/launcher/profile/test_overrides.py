"""What may change a profile from outside: extends, --set, DECK_* variables, the domain."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from launcher.errors import DomainError, ProfileError
from launcher.profile.load import Profile, load_profile
from tests.unit.profile_files import loaded, told, written

BASE = """\
title: {en: Base, ru: Основа}
lesson: 1
nodes:
  sonar:
    run: nodes.hello
    params: {rate: 1.0, limits: {near: 0.2, far: 3.0}}
    ready: {topic: /scan, within: 3}
  camera: {exec: [camera]}
devices:
  pico: {port: /dev/ttyACM0, baud: 115200}
panels: [sonar]
"""


def extended(folder: Path, text: str) -> Profile:
    """Load a profile that extends BASE."""
    written(folder, BASE, "base.yaml")
    return loaded(folder, "extends: base\n" + text)


def test_a_parameter_deep_down_is_overridden_and_the_rest_stays(tmp_path: Path) -> None:
    profile = extended(tmp_path, "nodes: {sonar: {params: {limits: {near: 0.5}}}}")
    assert profile.nodes["sonar"].params == {"rate": 1.0, "limits.near": 0.5, "limits.far": 3.0}
    assert profile.nodes["sonar"].document.run == "nodes.hello"
    assert profile.document.title == {"en": "Base", "ru": "Основа"}
    assert profile.document.panels == ("sonar",)


def test_readiness_and_titles_are_replaced_as_a_whole(tmp_path: Path) -> None:
    profile = extended(tmp_path, "title: {en: Own}\nnodes: {sonar: {ready: {node: sonar}}}")
    assert profile.document.title == {"en": "Own"}
    ready = profile.nodes["sonar"].ready
    assert ready is not None
    assert (ready.kind, ready.name, ready.within_s) == ("node", "sonar", 10.0)


def test_a_node_is_taken_out_by_null_and_one_added(tmp_path: Path) -> None:
    profile = extended(tmp_path, "nodes: {camera: null, brain: {exec: [x], needs: [sonar]}}")
    assert list(profile.nodes) == ["sonar", "brain"]


def test_exec_replaces_run(tmp_path: Path) -> None:
    profile = extended(tmp_path, "nodes: {sonar: {exec: [ros2, run, tof, sonar]}}")
    assert profile.nodes["sonar"].document.run is None
    assert profile.nodes["sonar"].argv()[:4] == ["ros2", "run", "tof", "sonar"]


def test_a_lesson_of_the_course_can_be_extended_from_anywhere(tmp_path: Path) -> None:
    profile = loaded(
        tmp_path, "extends: 01-hello\nnodes: {again: {run: nodes.hello, needs: [hello]}}"
    )
    assert list(profile.nodes) == ["hello", "again"]


def test_merge_keys_and_anchors_work(tmp_path: Path) -> None:
    profile = loaded(
        tmp_path,
        """\
        nodes:
          a: &common {exec: [x], restart: always, params: {rate: 1}}
          b: {<<: *common, params: {rate: 2}}
        """,
    )
    assert profile.nodes["b"].document.restart == "always"
    assert profile.nodes["b"].params == {"rate": 2}


@pytest.mark.parametrize(
    ("override", "name", "value"),
    [
        ("a.rate=2.5", "rate", 2.5),
        ("a.rate=2", "rate", 2),
        ('a.rate="2"', "rate", "2"),
        ("a.word=налево", "word", "налево"),
        ("a.empty=", "empty", ""),
        ("a.limits.near=0.5", "limits.near", 0.5),
        ("a.list=[1, 2]", "list", [1, 2]),
        ("a.url=http://x/?a=b", "url", "http://x/?a=b"),
        ("a.deep={x: 1}", "deep.x", 1),
    ],
)
def test_set_overrides_a_parameter(override: str, name: str, value: Any, tmp_path: Path) -> None:
    text = "nodes: {a: {exec: [x], params: {rate: 1.0, limits: {near: 1.0}}}}"
    profile = loaded(tmp_path, text, overrides=(override,))
    assert profile.nodes["a"].params[name] == value
    assert type(profile.nodes["a"].params[name]) is type(value)


@pytest.mark.parametrize(
    ("override", "message"),
    [
        ("rate=1", "expected node.param=value (write --set sonar_front.rate=2.0)"),
        ("a.rate", "expected node.param=value"),
        (".rate=1", "expected node.param=value"),
        ("sonr.rate=1", "there is no node 'sonr' (did you mean sonar?)"),
        ("sonar.rate=[", "a value is missing here, or a ']' or '}'"),
        ("sonar.rate=[]", "sonar.rate: an empty list has no type in ROS"),
        ("sonar.ra te=1", "'ra te' is not a valid name for a ROS parameter"),
        ("real.rate=1", "real does not run on this hardware"),
    ],
)
def test_a_wrong_set_is_told(override: str, message: str, tmp_path: Path) -> None:
    text = 'nodes:\n  sonar: {exec: [x]}\n  real: {exec: [x], when: hardware == "real"}'
    messages = told(tmp_path, text, overrides=(override,))
    assert len(messages) == 1
    assert messages[0].startswith(f"--set {override}")
    assert message in messages[0]


DEVICES = """\
devices:
  pico: {port: /dev/ttyACM0, baud: 115200, scale: 1.5}
nodes:
  chassis:
    exec: [chassis, --url, "serial:${devices.pico.port}", "${HOME}"]
    params: {port: "${devices.pico.port}", baud: "${devices.pico.baud}", k: "${devices.pico.scale}"}
    env: {PORT: "${devices.pico.port}"}
"""


def test_devices_are_put_in_with_their_types(tmp_path: Path) -> None:
    node = loaded(tmp_path, DEVICES).nodes["chassis"]
    assert node.params == {"port": "/dev/ttyACM0", "baud": 115200, "k": 1.5}
    assert node.document.exec == ("chassis", "--url", "serial:/dev/ttyACM0", "${HOME}")
    assert node.document.env == {"PORT": "/dev/ttyACM0"}


def test_variables_override_devices(tmp_path: Path) -> None:
    path = written(tmp_path, DEVICES)
    profile = load_profile(path, environ={"DECK_PICO_PORT": "/dev/x", "DECK_PICO_BAUD": "9600"})
    assert profile.nodes["chassis"].params == {"port": "/dev/x", "baud": 9600, "k": 1.5}
    assert profile.document.devices["pico"] == {"port": "/dev/x", "baud": 9600, "scale": 1.5}


def test_a_variable_of_the_wrong_type_is_told(tmp_path: Path) -> None:
    path = written(tmp_path, DEVICES)
    with pytest.raises(ProfileError, match="DECK_PICO_BAUD=fast replaces 115200, but is of anoth"):
        load_profile(path, environ={"DECK_PICO_BAUD": "fast"})


PLAIN = "nodes: {a: {exec: [x]}}"


def test_whose_domain_counts(tmp_path: Path) -> None:
    path = written(tmp_path, "domain: 7\n" + PLAIN)
    other = written(tmp_path, PLAIN, "other.yaml")
    assert load_profile(path, domain=9, environ={"ROS_DOMAIN_ID": "8"}).domain == 9
    assert load_profile(path, environ={"ROS_DOMAIN_ID": "8"}).domain == 7
    assert load_profile(other, environ={"ROS_DOMAIN_ID": "8"}).domain == 8
    assert 1 <= load_profile(other, environ={}).domain <= 101


@pytest.mark.parametrize("domain", ["x", "-1", "233", "1.5", "١٢٣٤"])
def test_a_domain_of_the_environment_that_is_none_is_told(domain: str, tmp_path: Path) -> None:
    with pytest.raises(DomainError, match=r"ROS_DOMAIN_ID: .* whole number from 0 to 232"):
        load_profile(written(tmp_path, PLAIN), environ={"ROS_DOMAIN_ID": domain})


def test_a_domain_whose_ports_may_be_taken_is_warned_of(tmp_path: Path) -> None:
    profile = loaded(tmp_path, "domain: 102\n" + PLAIN)
    assert [(problem.line, problem.column) for problem in profile.warnings] == [(1, 9)]
    assert "the ports of domains above 101 may be taken" in str(profile.warnings[0])
    assert loaded(tmp_path, "domain: 101\n" + PLAIN).warnings == ()


def test_static_peers_are_kept(tmp_path: Path) -> None:
    profile = loaded(tmp_path, "discovery: [192.168.1.7, robot.local, 'fe80::1%eth0']\n" + PLAIN)
    assert profile.document.discovery == ("192.168.1.7", "robot.local", "fe80::1%eth0")

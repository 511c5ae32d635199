"""The course's profiles, and how they, their files and their steps are found and read."""

from __future__ import annotations

from pathlib import Path

import pytest

from launcher.errors import ProfileNotFoundError
from launcher.profile.catalog import find_profile
from launcher.profile.load import load_profile
from launcher.profile.model import render
from launcher.profile.steps.checks import KINDS, kind_of
from launcher.profile.steps.expressions import ExpressionError, evaluate, filled
from tests.unit.profile_files import loaded, told, written

PROFILES = Path(__file__).parents[4] / "profiles"
LESSONS = sorted(PROFILES.glob("*.yaml"))


def test_every_lesson_is_there() -> None:
    assert [path.stem for path in LESSONS] == [
        *("01-hello", "02-sonar-safety", "03-head-service", "03b-drive-to-point"),
        *("04-ackermann", "04b-electronic-differential", "05-tf2", "06-rviz", "07-vision", "08-audio"),
        *("09-brain", "10-llm-json", "robot"),
    ]


@pytest.mark.parametrize("hardware", ["mock", "real"])
@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_is_valid_and_titled_in_both_languages(path: Path, hardware: str) -> None:
    profile = load_profile(path, hardware=hardware)
    assert set(profile.title) == set(profile.about) == {"en", "ru"}
    assert profile.warnings == ()
    assert profile.path.read_text().startswith("# yaml-language-server: $schema=schema.json")


def test_the_schema_is_true() -> None:
    assert (PROFILES / "schema.json").read_text() == render(), (
        "python -m launcher.profile.model > profiles/schema.json"
    )


@pytest.mark.parametrize(
    ("lesson", "node", "topic", "kind"),
    [
        ("09-brain", "ai_brain", "/ai_command", "std_msgs/msg/String"),
        ("robot", "ai_brain", "/ai_command", "std_msgs/msg/String"),
        ("05-tf2", "camera_tf", "/tf_static", "tf2_msgs/msg/TFMessage"),
        ("robot", "camera_tf", "/tf_static", "tf2_msgs/msg/TFMessage"),
    ],
)
def test_who_is_to_publish_a_topic_is_ready_by_it_and_its_type(lesson: str, node: str, topic: str, kind: str) -> None:
    ready = load_profile(PROFILES / f"{lesson}.yaml").nodes[node].ready
    assert ready is not None
    assert (ready.topic, ready.type) == (topic, kind)


def test_only_the_gate_leads_to_the_wheels_of_the_robot() -> None:
    nodes = load_profile(PROFILES / "robot.yaml").nodes
    assert nodes["safety_stop"].params["gate"] is True
    assert nodes["safety_stop"].params["rear_topic"] == "/sensor/sonar_rear"
    assert nodes["electronic_differential"].params["drive_topic"] == "/drive_safe"
    assert nodes["drive_to_point"].remap == {"/drive": "/drive_action"}
    assert nodes["drive_to_point"].params["simulate"] == "never"


def test_the_front_sonar_of_the_brain_lesson_is_where_the_gate_listens() -> None:
    nodes = load_profile(PROFILES.parent / "lessons" / "09-brain" / "starter" / "lesson.yaml").nodes
    assert nodes["sonar_front"].params["topic"] == "/sensor/sonar_front"


def test_nobody_tells_the_robot_to_drive_before_a_user_does() -> None:
    assert load_profile(PROFILES / "robot.yaml").nodes["mock_audio"].params["period"] == 0


@pytest.fixture
def elsewhere(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(
    ("asked", "found"),
    [
        ("09-brain", "09-brain"), ("9", "09-brain"), ("09", "09-brain"), ("1", "01-hello"),
        ("10", "10-llm-json"), ("4", "04-ackermann"), ("4b", "04b-electronic-differential"),
        ("06-r", "06-rviz"),
    ],
)  # fmt: skip
def test_a_lesson_is_found_by_what_people_type(asked: str, found: str) -> None:
    assert find_profile(asked).stem == found


@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize(
    ("asked", "near"), [("brain", "09-brain"), ("09-brian", "09-brain"), ("sonar", "02-sonar-safety")]
)
def test_a_wrong_name_gets_a_suggestion(asked: str, near: str) -> None:
    with pytest.raises(ProfileNotFoundError) as caught:
        find_profile(asked)
    assert near in caught.value.near
    assert near in str(caught.value)


NEVER = "raise SystemExit('never imported')"


def test_a_file_stands_relative_to_the_profile_that_names_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """And not to one that extends it from another folder, or to the current folder."""
    robot, other = tmp_path / "robot", tmp_path / "other"
    for folder in (robot, other):
        folder.mkdir()
        (folder / "my_sonar.py").write_text(NEVER)
    written(robot, "nodes: {a: {run: ./my_sonar.py}}", "robot.yaml")
    written(other, "extends: ../robot/robot.yaml\nnodes: {b: {run: ../robot/my_sonar.py}}")
    monkeypatch.chdir(other)
    nodes = load_profile("lesson.yaml").nodes
    assert nodes["a"].run == nodes["b"].run == str(robot / "my_sonar.py")
    assert nodes["a"].command == "./my_sonar.py"
    assert nodes["a"].argv()[-4:] == [*(str(robot / "my_sonar.py"), "--ros-args", "-r", "__node:=a")]


HEAD = "nodes: {sonar: {exec: [x]}}\nvalues: {near_m: {between: [0.1, 0.4], digits: 3}}\nsteps:\n"
BAD = {
    "a kind misspelt": ("  - {id: a, checks: [{nod: /a}]}",
     ["4:22: steps[0].checks[0]: no kind of check is named here (did you mean node?)"]),
    "a key misspelt": ("  - {id: a, checks: [{log: sonar, matches: x, levl: info}]}",
     ["4:47: steps[0].checks[0].levl: unknown key (did you mean level?)"]),
    "a key of what follows misspelt": (
        (
            "  - id: a\n    checks:\n      - publish: /a\n        type: std_msgs/msg/Bool\n"
            "        then: [{log: sonar, matches: x, levl: warn}]"
        ),
        ["8:41: steps[0].checks[0].then[0].levl: unknown key (did you mean level?)"],
    ),
    "a value that is not drawn": (
        "  - {id: a, checks: [{field: /a, type: a/msg/B, path: data, equals: '${neer_m}'}]}",
        [
            "4:69: steps[0].checks[0].equals: there is no value 'neer_m': did you mean near_m?",
        ],
    ),
    "a node that is not there": ("  - {id: a, checks: [{log: sonr, matches: x}]}",
     ["4:28: steps[0].checks[0].log: there is no node 'sonr' (did you mean sonar?)"]),
    "two conditions at once": (
        "  - {id: a, checks: [{field: /a, type: a/msg/B, path: data, changes: true, equals: 1}]}",
        [
            "4:22: steps[0].checks[0]: expected exactly one of between, equals, changes, matches",
        ],
    ),
    "the same id twice": ("  - {id: a, checks: [{node: /a}]}\n  - {id: a, checks: [{node: /a}]}",
     ["5:10: steps[1].id: there is a step 'a' already"]),
    "a step that waits for a later one": (
        "  - {id: a, needs: [bb], checks: [{node: /a}]}\n  - {id: bb, checks: [{node: /a}]}",
        ["4:21: steps[0].needs[0]: no step before this one is called 'bb'"],
    ),
    "no checks": ("  - {id: a, checks: []}", ["4:21: steps[0].checks: `checks` is empty"]),
    "a pattern that cannot be one": (
        "  - {id: a, checks: [{log: sonar, matches: '('}]}",
        [
            (
                "4:44: steps[0].checks[0].matches: '(' is not a regular expression: missing ), "
                "unterminated subpattern at position 0"
            )
        ],
    ),
    "a call that follows": (
        "  - {id: a, checks: [{publish: /a, type: std_msgs/msg/Bool, then: [{node: /a}]}]}",
        [
            (
                "4:68: steps[0].checks[0].then[0]: only these can follow: field, log, python, topic"
            )
        ],
    ),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_what_is_wrong_with_a_step_is_told_with_its_place(case: str, tmp_path: Path) -> None:
    written, wanted = BAD[case]
    assert told(tmp_path, HEAD + written) == wanted


def test_every_kind_is_read_by_its_own_key(tmp_path: Path) -> None:
    text = (
        HEAD
        + "  - id: a\n    checks:\n"
        + "".join(
            f"      - {{{check}}}\n"
            for check in (
                "node: sonar, ends: 0",
                "topic: /a, type: std_msgs/msg/Bool, by: /b, rate: [1, '${near_m * 10}']",
                "subscription: /a, by: /b",
                "field: /a, type: std_msgs/msg/Bool, path: data, equals: true",
                "service: /a, type: std_srvs/srv/Trigger, response: {success: true}",
                "action: /a, type: a_msgs/action/Go, cancel: true",
                "publish: /a, type: a/msg/B, then: [{topic: /b, type: a/msg/B, silent: 2}]",
                "parameter: p, of: /a, type: double",
                "log: sonar, matches: x",
                "python: checks.py:f, topics: {/a: std_msgs/msg/Bool}",
            )
        )
    )
    (step,) = loaded(tmp_path, text).steps
    assert {kind_of(check) for check in step.checks} == set(KINDS)


@pytest.mark.parametrize("bad", ["v +", "__import__('os')", "v.real", "1 / 0", "missing", "[1]"])
def test_anything_else_is_refused(bad: str) -> None:
    with pytest.raises(ExpressionError):
        evaluate(bad, {"v": 1.0})


def test_a_drawn_number_is_written_as_the_language_of_its_text_has_it() -> None:
    what = {"en": "at ${v + 0.1} m/s", "ru": "едем со скоростью ${v + 0.1} м/с"}
    assert filled({"what": what, "data": "go ${v}"}, {"v": 0.3}) == {
        "what": {"en": "at 0.4 m/s", "ru": "едем со скоростью 0,4 м/с"},
        "data": "go 0.3",
    }

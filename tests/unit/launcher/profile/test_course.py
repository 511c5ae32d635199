"""The course's own profiles are right, and the schema beside them says what the model says."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from launcher.profile.catalog import list_profiles
from launcher.profile.load import load_profile
from launcher.profile.schema import render
from tests.unit.profile_files import written

PROFILES = Path(__file__).parents[4] / "profiles"
LESSONS = sorted(PROFILES.glob("*.yaml"))


def test_every_lesson_is_there() -> None:
    assert [path.stem for path in LESSONS] == [
        *("01-hello", "02-sonar-safety", "03-head-service", "03b-drive-to-point"),
        *(
            "04-ackermann",
            "04b-electronic-differential",
            "05-tf2",
            "06-rviz",
            "07-vision",
            "08-audio",
        ),
        *("09-brain", "10-llm-json", "robot"),
    ]


@pytest.mark.parametrize("hardware", ["mock", "real"])
@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_is_valid_and_titled_in_both_languages(path: Path, hardware: str) -> None:
    profile = load_profile(path, hardware=hardware)
    assert set(profile.document.title) == set(profile.document.about) == {"en", "ru"}
    assert profile.warnings == ()
    assert profile.path.read_text().startswith("# yaml-language-server: $schema=schema.json")


@pytest.mark.parametrize("path", LESSONS, ids=lambda path: path.stem)
def test_a_lesson_can_be_extended_from_any_folder(path: Path, tmp_path: Path) -> None:
    profile = load_profile(written(tmp_path, f"extends: {path.stem}"))
    assert profile.nodes == load_profile(path).nodes


def test_the_schema_is_true() -> None:
    assert (PROFILES / "schema.json").read_text() == render(), (
        "python -m launcher.profile.schema > profiles/schema.json"
    )


def test_the_schema_names_every_key_and_choice() -> None:
    schema = json.loads(render())
    node = schema["$defs"]["NodeDocument"]["properties"]
    assert set(schema["properties"]) >= {"nodes", "title", "domain", "discovery", "extends"}
    assert node["restart"]["enum"] == ["never", "on-failure", "always"]
    assert all("description" in key for key in (*schema["properties"].values(), *node.values()))
    assert schema["additionalProperties"] is False


def test_the_brain_lesson_has_its_nine_nodes() -> None:
    profile = load_profile(PROFILES / "09-brain.yaml")
    assert list(profile.nodes) == [
        *("sonar_front", "camera", "audio", "head_controller", "ai_driver"),
        *("safety_stop", "electronic_differential", "llm_parser", "ai_brain"),
    ]
    assert profile.nodes["safety_stop"].params["gate"] is True
    assert profile.nodes["electronic_differential"].params["drive_topic"] == "/drive_safe"
    assert not any(node.needs for node in profile.nodes.values()), "all start at once"


@pytest.mark.parametrize(
    ("lesson", "node", "topic", "kind"),
    [
        ("09-brain", "ai_brain", "/ai_command", "std_msgs/msg/String"),
        ("robot", "ai_brain", "/ai_command", "std_msgs/msg/String"),
        ("05-tf2", "camera_tf", "/tf_static", "tf2_msgs/msg/TFMessage"),
        ("robot", "camera_tf", "/tf_static", "tf2_msgs/msg/TFMessage"),
    ],
)
def test_who_is_to_publish_a_topic_is_ready_by_it_and_its_type(
    lesson: str, node: str, topic: str, kind: str
) -> None:
    ready = load_profile(PROFILES / f"{lesson}.yaml").nodes[node].ready
    assert ready is not None
    assert (ready.kind, ready.name, ready.type) == ("topic", topic, kind)


def test_the_robot_has_the_same_drivers_on_mock_and_on_real_hardware() -> None:
    mock = load_profile(PROFILES / "robot.yaml").nodes
    real = load_profile(PROFILES / "robot.yaml", hardware="real").nodes
    for name in ("chassis", "sonar_front", "sonar_rear", "head_controller", "safety_stop"):
        assert mock[name].document.run == real[name].document.run
        assert {**mock[name].params, "port": ""} == {**real[name].params, "port": ""}
    assert not [name for name, node in real.items() if "mock" in str(node.document.run)]
    assert set(real) - set(mock) == {"camera", "audio", "hearing", "speaking"}
    assert set(mock) - set(real) == {"mock_robot", "mock_camera", "mock_audio"}


def test_only_the_gate_leads_to_the_wheels_of_the_robot() -> None:
    nodes = load_profile(PROFILES / "robot.yaml").nodes
    assert nodes["safety_stop"].params["gate"] is True
    assert nodes["safety_stop"].params["rear_topic"] == "/sensor/sonar_rear"
    assert nodes["electronic_differential"].params["drive_topic"] == "/drive_safe"
    assert nodes["drive_to_point"].document.remap == {"/drive": "/drive_action"}
    assert nodes["drive_to_point"].params["simulate"] == "never"


def test_rviz_is_optional() -> None:
    rviz = load_profile(PROFILES / "06-rviz.yaml").nodes["rviz"]
    assert rviz.document.optional
    assert rviz.cwd is not None
    assert (rviz.cwd / "robot.rviz").is_file()


def test_the_catalog_lists_the_lessons_in_order(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    assert [entry.path for entry in list_profiles()] == LESSONS

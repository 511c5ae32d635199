"""The words that drive, what the brain makes of them, and which topics move a robot."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from robot.commands.brain import Decision, asks_to_stop, decide, spoken
from robot.limits import SPEED, STEERING
from robot.safety.distance import RangeState
from robot.words import STOP, DriveSetpoint, parse_spoken, parse_word
from safety.moving_topics import moves


@pytest.mark.parametrize(
    ("russian", "english", "setpoint"),
    [
        ("вперед", "forward", DriveSetpoint(0.5, 0.0)),
        ("налево", "left", DriveSetpoint(0.3, 0.5)),
        ("направо", "right", DriveSetpoint(0.3, -0.5)),
        ("назад", "back", DriveSetpoint(-0.3, 0.0)),
        ("стоп", "stop", STOP),
    ],
)
def test_the_course_s_five_words(russian: str, english: str, setpoint: DriveSetpoint) -> None:
    assert parse_word(russian) == parse_word(english) == setpoint


@pytest.mark.parametrize("word", ["вперёд", "ВПЕРЁД", "  Вперед\n", "впере\u0308д", "вперед!"])
def test_spelling_case_and_blanks_do_not_matter(word: str) -> None:
    assert parse_word(word) == DriveSetpoint(0.5, 0.0)


@pytest.mark.parametrize("word", ["", "   ", "прыжок", "forwards", "сто п", "!", "стоп стоп", "\0"])
def test_any_other_word_means_nothing(word: str) -> None:
    assert parse_word(word) is None


@given(st.text())
def test_no_text_leads_out_of_range(text: str) -> None:
    setpoint = parse_word(text)
    assert setpoint is None or (setpoint.speed_m_s in SPEED and setpoint.steering_rad in STEERING)


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("robot forward", "forward"), ("Robot, turn left!", "left"),
        ("Робот, поезжай вперёд.", "вперед"), ("робот осмотрись", "осмотрись"),
        ("robot have a look round", "look around"), ("stop", "stop"), ("Стоп!", "стоп"),
        ("стой", "стоп"), ("forward", None), ("turn left", None), ("вперёд", None),
        ("look around", None), ("robot", None), ("robot robot forward", None),
        ("robot forward please", None), ("the robot stop", None), ("", None),
    ],
)  # fmt: skip
def test_only_what_is_said_to_the_robot_means_something(text: str, meant: str | None) -> None:
    assert parse_spoken(text) == meant


FORWARD = DriveSetpoint(0.5, 0.0)


@pytest.mark.parametrize(
    ("front", "decision"),
    [
        (RangeState.FREE, Decision.LOOK_AND_GO),
        (RangeState.CLOSE, Decision.OBSTACLE),
        (RangeState.INVALID, Decision.BLIND),
        (RangeState.SILENT, Decision.BLIND),
    ],
)
def test_a_request_is_answered_by_what_is_ahead(front: RangeState, decision: Decision) -> None:
    assert decide(None, front) == decision


@given(st.sampled_from(RangeState))
def test_stop_and_back_are_always_obeyed(front: RangeState) -> None:
    assert decide(STOP, front) == Decision.OBEY
    assert decide(parse_word("назад"), front) == Decision.OBEY


@given(st.sampled_from(RangeState))
def test_forward_is_obeyed_only_where_the_way_is_free(front: RangeState) -> None:
    assert (decide(FORWARD, front) == Decision.OBEY) == (front == RangeState.FREE)


@pytest.mark.parametrize(
    ("sound", "words"),
    [
        (b"VOICE_COMMAND: Look around", "Look around"),
        (" voice_command:  Стоп \n".encode(), "Стоп"),
        (b"left", "left"),
        (b"\xff\xfe", "��"),
        (b"", ""),
    ],
)
def test_the_words_are_taken_from_the_bytes(sound: bytes, words: str) -> None:
    assert spoken(sound) == words


@pytest.mark.parametrize("words", ["stop", "STOP!!", "please stop, robot", "Стоп, машина", "стой!"])
def test_the_word_for_stop_is_found_among_others(words: str) -> None:
    assert asks_to_stop(words)


@pytest.mark.parametrize("words", ["", "forward", "what do you see?", "поехали", "unstoppable"])
def test_other_words_are_no_stop(words: str) -> None:
    assert not asks_to_stop(words)


DRIVE = "ackermann_msgs/msg/AckermannDriveStamped"
TEXT = "std_msgs/msg/String"


@pytest.mark.parametrize(
    ("name", "type_name", "moving"),
    [
        *((f"/drive{end}", DRIVE, True) for end in ("", "_teleop", "_action", "_safe")),
        ("/wheel_commands", "sensor_msgs/msg/JointState", True),
        ("/ai_command", TEXT, True),
        ("/llm_raw_json", TEXT, True),
        ("/audio/mic_raw", "std_msgs/msg/ByteMultiArray", True),
        ("/audio/heard", TEXT, True),
        ("/cmd_vel", "geometry_msgs/msg/Twist", True),
        ("/sensor/sonar_front", "std_msgs/msg/Float32", False),
        ("/head_state", "sensor_msgs/msg/JointState", False),
        ("/camera/color/image_raw", "sensor_msgs/msg/Image", False),
        ("/llm_result", TEXT, False),
    ],
)
def test_commands_move_a_robot_and_what_it_tells_does_not(name: str, type_name: str, moving: bool) -> None:
    assert moves(name, type_name) is moving

"""Steps of a lesson: what is wrong with one is told with its place, and values are drawn anew."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from launcher.profile.steps.checks import KINDS, kind_of
from launcher.profile.steps.draw import draw
from launcher.profile.steps.expressions import Drawn, ExpressionError, evaluate, filled
from launcher.profile.steps.model import ValueDocument
from tests.unit.profile_files import loaded, told

HEAD = "nodes: {sonar: {exec: [x]}}\nvalues: {near_m: {between: [0.1, 0.4], digits: 3}}\nsteps:\n"
BAD = {
    "a kind misspelt": (
        "  - {id: a, checks: [{nod: /a}]}",
        ["4:22: steps[0].checks[0]: no kind of check is named here (did you mean node?)"],
    ),
    "a key misspelt": (
        "  - {id: a, checks: [{rate: /a, between: [1, 2], ovr: 1}]}",
        ["4:50: steps[0].checks[0].ovr: unknown key (did you mean over?)"],
    ),
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
    "a node that is not there": (
        "  - {id: a, checks: [{log: sonr, matches: x}]}",
        ["4:28: steps[0].checks[0].log: there is no node 'sonr' (did you mean sonar?)"],
    ),
    "two conditions at once": (
        "  - {id: a, checks: [{field: /a, type: a/msg/B, path: data, changes: true, equals: 1}]}",
        [
            "4:22: steps[0].checks[0]: expected exactly one of between, equals, changes, matches",
        ],
    ),
    "the same id twice": (
        "  - {id: a, checks: [{node: /a}]}\n  - {id: a, checks: [{node: /a}]}",
        ["5:10: steps[1].id: there is a step 'a' already"],
    ),
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
                "4:68: steps[0].checks[0].then[0]: only these can follow: field, log, nothing, "
                "python, image, rate"
            )
        ],
    ),
}


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
                "node: /a",
                "topic: /a, type: std_msgs/msg/Bool, by: /b",
                "subscription: /a, by: /b",
                "image: /a, rate: [1, 2]",
                "rate: /a, between: [1, '${near_m * 10}']",
                "field: /a, type: std_msgs/msg/Bool, path: data, equals: true",
                "qos: /a, reliability: reliable",
                "service: /a, type: std_srvs/srv/Trigger, response: {success: true}",
                "action: /a, type: a_msgs/action/Go, cancel: true",
                "publish: /a, type: a/msg/B, then: [{nothing: /b, type: a/msg/B, for: 2}]",
                "nothing: /a, type: std_msgs/msg/Bool",
                "parameter: p, of: /a, type: double",
                "transform: {from: a, to: b}, translation: [0.15, 0, 0.25]",
                "log: sonar, matches: x",
                "ends: sonar",
                "no_publisher: /a, except: /b",
                "gate: /a, from: /b, distance: /c, stop_below: 0.5",
                "python: checks.py:f, topics: {/a: std_msgs/msg/Bool}",
            )
        )
    )
    (step,) = loaded(tmp_path, text).document.steps
    assert {kind_of(check) for check in step.checks} == set(KINDS)


def _value(**fields: Any) -> ValueDocument:
    return ValueDocument.model_validate(fields)


def test_a_seed_always_draws_the_same_and_another_seed_something_else() -> None:
    values = {
        "near_m": _value(between=(0.1, 0.4), digits=3),
        "pan": _value(between=(-80, 80)),
        "word": _value(one_of=("вперед", "назад")),
    }
    drawn = draw(values, 7)
    assert drawn == draw(values, 7)
    assert len({draw(values, seed)["near_m"] for seed in range(50)}) > 20
    assert isinstance(drawn["pan"], int)
    assert -80 <= drawn["pan"] <= 80
    assert drawn["word"] in ("вперед", "назад")
    # Values of the others stay when one is taken out.
    assert draw({"pan": values["pan"]}, 7)["pan"] == drawn["pan"]


def test_an_expression_is_computed_or_written_out() -> None:
    values: dict[str, Drawn] = {"v": 0.3, "word": "налево"}
    assert filled("${-v * 2}", values) == pytest.approx(-0.6)
    assert filled("едем ${word}, ${v + 0.1} м/с", values) == "едем налево, 0.4 м/с"
    assert evaluate("tan(pi / 4)", {}) == pytest.approx(math.tan(math.pi / 4))


@pytest.mark.parametrize("bad", ["v +", "__import__('os')", "v.real", "1 / 0", "missing", "[1]"])
def test_anything_else_is_refused(bad: str) -> None:
    with pytest.raises(ExpressionError):
        evaluate(bad, {"v": 1.0})

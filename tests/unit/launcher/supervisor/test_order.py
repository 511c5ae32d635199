"""Who is started and stopped in which order."""

from __future__ import annotations

from launcher.supervisor.dependencies import stop_waves, with_needs

NEEDS = {
    "sonar": (),
    "camera": (),
    "safety": ("sonar",),
    "drive": ("safety",),
    "brain": ("camera", "drive"),
}


def test_what_a_node_needs_comes_before_it() -> None:
    assert with_needs(["brain"], NEEDS) == ["camera", "sonar", "safety", "drive", "brain"]
    assert with_needs(["safety", "sonar"], NEEDS) == ["sonar", "safety"]


def test_dependants_are_stopped_first() -> None:
    waves = stop_waves(NEEDS, NEEDS)
    assert waves == [["brain"], ["camera", "drive"], ["safety"], ["sonar"]]


def test_a_node_between_two_that_stay_does_not_matter() -> None:
    assert stop_waves(["sonar", "drive"], NEEDS) == [["drive"], ["sonar"]]
    assert stop_waves(["camera", "sonar"], NEEDS) == [["camera", "sonar"]]
    assert stop_waves([], NEEDS) == []

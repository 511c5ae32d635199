"""Which nodes of a plan are Deck's own: all others can be confined."""

from __future__ import annotations

from pathlib import Path

from launcher.supervisor.exchange import exchanged
from launcher.supervisor.plan import NodePlan, plan_of
from tests.unit.profile_files import loaded

PROFILE = """
title: {en: Mixed}
nodes:
  sonar: {run: nodes.mock_sonar}
  cold: {run: nodes.mock_sonar, warm: false}
  mine: {run: ./talker.py}
  program: {exec: [python3, ./talker.py]}
  other: {exec: [sleep, "100"]}
"""


def planned(folder: Path) -> dict[str, NodePlan]:
    (folder / "talker.py").write_text("")
    profile = loaded(folder, PROFILE, domain=1)
    plan = plan_of(profile, run_dir="", log_dir="", foreground=True, node_lang="")
    return {node.name: node for node in plan.nodes}


def test_only_modules_of_deck_are_its_own(tmp_path: Path) -> None:
    ours = {name for name, node in planned(tmp_path).items() if node.ours}
    assert ours == {"sonar", "cold"}


def test_a_file_in_the_place_of_a_module_is_not_decks_own(tmp_path: Path) -> None:
    sonar = planned(tmp_path)["sonar"]
    mine = exchanged(sonar, str(tmp_path / "talker.py"))
    assert not mine.ours
    assert exchanged(mine, "nodes.mock_sonar").ours

"""The lesson that docs/profiles.md has a teacher write is found, checked and run as it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.deck_process import deck

pytestmark = pytest.mark.nightly

DOCS = Path(__file__).resolve().parents[3] / "docs"
PAGES = ["profiles.md", "profiles.ru.md"]


@pytest.fixture(autouse=True)
def _domain(ros_domain: int) -> int:
    return ros_domain


def handed_out(folder: Path, page: str) -> Path:
    """Write the two files that the page shows, in the folders that it shows."""
    text = (DOCS / page).read_text()
    (profile,) = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
    (node,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    profiles = folder / "profiles"
    profiles.mkdir()
    (profiles / "20-my-sonar.yaml").write_text(profile)
    (profiles / "my_sonar.py").write_text(node)
    return profiles


@pytest.mark.parametrize("page", PAGES)
def test_the_lesson_of_the_page_is_well(tmp_path: Path, page: str) -> None:
    handed_out(tmp_path, page)
    assert deck("check", "20", cwd=tmp_path).process.returncode == 0
    assert "20-my-sonar" in "\n".join(deck("list", cwd=tmp_path).lines)
    run = deck("run", "20", "--for", "1", "--json", cwd=tmp_path)
    assert run.process.returncode == 0, run.lines
    assert {node["node"]: node["state"] for node in run.events()[-1]["nodes"]} == {
        "sonar_front": "ready",
        "safety_stop": "ready",
    }
    said = [event.get("text", "") for event in run.events()]
    assert any("0.30 m" in text for text in said), said


@pytest.mark.parametrize(
    ("before", "after", "reason"),
    [
        ("create_timer(0.1", "create_timer(0.4", r"arrives at [1-4](\.\d)? Hz, expected 5 Hz"),
        ("/sensor/sonar_front", "/sensor/sonar_frnt", "/sensor/sonar_front"),
        ("rclpy.init()", "raise SystemExit(3)", "3"),
        ("rclpy.spin(MySonar())", "MySonar()", r"rclpy\.spin\(node\) is missing"),
    ],
)
def test_what_a_learner_does_wrong_ends_the_run_with_one(
    tmp_path: Path, before: str, after: str, reason: str
) -> None:
    node = handed_out(tmp_path, PAGES[0]) / "my_sonar.py"
    node.write_text(node.read_text().replace(before, after))
    run = deck("run", "20", "--for", "1", "--json", cwd=tmp_path)
    nodes = {node["node"]: node for node in run.events()[-1]["nodes"]}
    assert (run.process.returncode, nodes["sonar_front"]["healthy"]) == (1, False)
    assert re.search(reason, nodes["sonar_front"]["detail"])

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
    *_shortest, profile = re.findall(r"```yaml\n(.*?)```", text, re.DOTALL)
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

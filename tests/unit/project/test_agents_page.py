"""The pages on agents name every tool, key and limit, and their profile is valid."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from agents.tools import CALL, PUBLISH, TOOLS
from cli.arguments.thinking import MCP_PORT
from launcher.consent import AUDIT_FILE, DEFAULT_RULES, Approval
from launcher.profile.load import load_profile

ROOT = Path(__file__).resolve().parents[3]


@pytest.fixture(params=["agents.md", "agents.ru.md"])
def page(request: pytest.FixtureRequest) -> str:
    """The text of the page, in each language."""
    name: str = request.param
    return (ROOT / "docs" / name).read_text("utf-8")


def test_every_tool_stands_in_the_table_and_no_other(page: str) -> None:
    rows = re.findall(r"^\| ((?:`\w+`(?:, )?)+) \|.*\|.*\|$", page, re.MULTILINE)
    named = [name for row in rows for name in re.findall(r"`(\w+)`", row)]
    assert sorted(named) == sorted(tool.name for tool in (*TOOLS, PUBLISH, CALL))


def test_the_profile_shown_is_valid_and_shows_the_defaults(page: str, tmp_path: Path) -> None:
    (text,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    path = tmp_path / "mine.yaml"
    path.write_text(text, "utf-8")
    rules = load_profile(path).document.agents
    assert (rules.max_speed_m_s, rules.max_distance_m, rules.max_total_m) == (
        DEFAULT_RULES.max_speed_m_s,
        DEFAULT_RULES.max_distance_m,
        DEFAULT_RULES.max_total_m,
    )
    assert (rules.publish, rules.call) == (("/lamp",), ("/lamp_on",))


def test_keys_approvals_port_and_file_are_named(page: str) -> None:
    for words in ("Shift+F4", "Shift+F5", "Shift+F9", f":{MCP_PORT}/mcp", AUDIT_FILE):
        assert words in page
    for approval in (Approval.NEVER, Approval.ALWAYS):
        assert f"--approve {approval.value}" in page

"""What the READMEs show is what Deck does: profiles, lessons, keys, commands, files."""

from __future__ import annotations

import re
from pathlib import Path
from typing import get_args

import pytest
import yaml
from textual.app import App

from cli.arguments.commands import COMMANDS
from launcher.profile.catalog import list_profiles
from launcher.profile.load import load_profile
from launcher.profile.model import NodeDocument, ProfileDocument
from launcher.profile.panels import Panel
from tui.actions import REGISTRY
from tui.app import DeckApp

ROOT = Path(__file__).resolve().parents[3]
READMES = ["README.md", "README.ru.md"]


@pytest.fixture(params=READMES)
def readme(request: pytest.FixtureRequest) -> str:
    """The text of a README, in each language."""
    name: str = request.param
    return (ROOT / name).read_text()


def test_a_bare_machine_of_ci_has_what_the_readme_installs_and_no_more(readme: str) -> None:
    """Else `make test` passes there and fails at a stranger's."""
    workflow = (ROOT / ".github/workflows/ci.yml").read_text()
    (line,) = re.findall(r"`apt install ([^`]*)`", readme)
    (installed,) = re.findall(
        r"^ +apt-get install -qy --no-install-recommends (.*)$", workflow, re.MULTILINE
    )
    assert installed.split() == line.split()


def test_the_profile_shown_is_valid_and_starts_what_it_says(readme: str, tmp_path: Path) -> None:
    (text,) = re.findall(r"```yaml\n(.*?)```", readme, re.DOTALL)
    path = tmp_path / "mine.yaml"
    path.write_text(text)
    profile = load_profile(path)
    assert list(profile.nodes) == ["sonar_front", "safety_stop"]
    assert profile.nodes["safety_stop"].needs == ("sonar_front",)


def test_both_readmes_show_the_same_profile() -> None:
    shown = [
        re.findall(r"```yaml\n(.*?)```", (ROOT / name).read_text(), re.DOTALL) for name in READMES
    ]
    english, russian = (yaml.safe_load(text) for (text,) in shown)
    assert english == russian


def test_every_lesson_is_listed_and_no_other(readme: str) -> None:
    listed = re.findall(r"^\| (\d\w*-[\w-]+) \|", readme, re.MULTILINE)
    assert listed == [entry.name for entry in list_profiles() if entry.lesson]


def test_every_command_shown_exists(readme: str) -> None:
    shown = set(re.findall(r"^deck ([a-z]+) ", readme, re.MULTILINE))
    shown -= {entry.name for entry in list_profiles()}
    assert shown == {
        "run",
        "list",
        "check",
        "up",
        "new",
        "grade",
        "shell",
        "record",
        "replay",
        "watch",
        "level",
        "model",
        "mcp",
        "doctor",
        "diagnostics",
        "frames",
        "view",
        "foxglove",
    }
    assert shown | {"ps", "logs", "attach", "down"} <= set(COMMANDS)


@pytest.mark.parametrize(
    "page",
    [
        *READMES,
        "SECURITY.md",
        *(
            f"docs/{name}.md"
            for name in ("agents", "agents.ru", "profiles", "profiles.ru", "view", "view.ru")
        ),
    ],
)
def test_every_file_linked_is_there(page: str) -> None:
    links = re.findall(r"\]\(((?!https?:)[^)#]+)", (ROOT / page).read_text())
    assert links
    for link in links:
        assert (ROOT / page).parent.joinpath(link).exists(), link


@pytest.mark.parametrize("page", ["docs/profiles.md", "docs/profiles.ru.md"])
def test_the_page_on_profiles_tells_every_key_and_panel(page: str) -> None:
    text = (ROOT / page).read_text()
    keys = {*ProfileDocument.model_fields, *NodeDocument.model_fields} - {"warm"}
    assert not [key for key in keys if f"`{key}`" not in text]
    assert not [panel for panel in get_args(Panel) if f"`{panel}`" not in text]


@pytest.mark.parametrize(
    ("key", "action"),
    [
        ("space", "emergency.stop"),
        ("ctrl+x", "emergency.stop"),
        ("ctrl+r", "emergency.release"),
        ("f2", "screen.deck"),
        ("f3", "screen.topics"),
        ("f4", "screen.composer"),
        ("f5", "screen.logs"),
        ("f1", "app.help"),
        ("f6", "recording.toggle"),
        ("f7", "replay.toggle"),
        ("f8", "session.close"),
        ("f9", "app.language"),
        ("f10", "app.theme"),
        ("q", "app.quit"),
        ("ctrl+q", "app.quit"),
    ],
)
def test_the_keys_shown_do_what_is_said(key: str, action: str) -> None:
    assert issubclass(DeckApp, App)  # the app's module brings its actions
    assert key in REGISTRY[action].key.split(",")

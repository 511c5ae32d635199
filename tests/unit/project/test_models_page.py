"""docs/models.md, in both languages: its settings can be used, and its options exist."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from brain.settings import ModelSettings, load
from cli.arguments.commands import parser_of

ROOT = Path(__file__).parents[3]


@pytest.fixture(params=["docs/models.md", "docs/models.ru.md"])
def page(request: pytest.FixtureRequest) -> str:
    """The text of the page."""
    return Path(ROOT, request.param).read_text(encoding="utf-8")


def test_the_settings_shown_can_be_used(page: str, tmp_path: Path) -> None:
    (text,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    path = tmp_path / "llm.yaml"
    path.write_text(text, encoding="utf-8")
    settings = load(path, environ={})
    assert settings is not None
    assert settings.prices is not None
    same = ModelSettings(base_url=settings.base_url, model=settings.model)
    for shown in ("timeout_s", "first_token_s", "budget"):
        assert getattr(settings, shown) == getattr(same, shown)


def test_the_options_shown_exist_and_no_others(
    page: str, capsys: pytest.CaptureFixture[str]
) -> None:
    shown = set(re.findall(r"^\| `(--[a-z]+) ", page, re.MULTILINE)) | {"--verbose"}
    with pytest.raises(SystemExit):
        parser_of("model").parse_args(["serve", "--help"])
    options = set(re.findall(r"^  (--[a-z]+)", capsys.readouterr().out, re.MULTILINE))
    assert options - {"--lang"} == shown

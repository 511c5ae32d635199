"""The lines of a log view are written to a file, and never over one unasked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from textual.app import App

from tests.tui.logs.bare_log import LogApp, lines, shown
from tui.log_view.prompt import LogPrompt

if TYPE_CHECKING:
    from textual.pilot import Pilot


async def answer(pilot: Pilot[None], path: Path) -> None:
    app = pilot.app
    assert isinstance(app, LogApp)
    field = app.pane.prompt.query_one("Input")
    field.value = str(path)  # type: ignore[attr-defined]
    await pilot.press("enter")
    await app.workers.wait_for_complete()
    await pilot.pause()


def remark(app: App[None]) -> str:
    return str(app.query_one(LogPrompt).query_one("#remark").render())


async def test_lines_are_written_to_a_file_and_never_over_one_unasked(tmp_path: Path) -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        await shown(pilot, lines(1, 100))
        app = pilot.app
        assert isinstance(app, LogApp)
        app.pane.save_folder = str(tmp_path)
        app.pane.save()
        await pilot.pause()
        proposed = app.pane.prompt.query_one("Input").value  # type: ignore[attr-defined]
        assert Path(proposed).parent == tmp_path
        path = tmp_path / "new" / "my.log"
        await answer(pilot, path)
        assert len(path.read_text(encoding="utf-8").splitlines()) == 100
        path.write_text("mine", encoding="utf-8")
        app.pane.save()
        await answer(pilot, path)
        assert path.read_text(encoding="utf-8") == "mine"
        assert "Enter again to overwrite" in remark(app)
        await answer(pilot, path)
        assert path.read_text(encoding="utf-8").endswith("line 100\n")
        assert app.pane.view.has_focus


async def test_a_file_that_cannot_be_written_is_told_in_words(tmp_path: Path) -> None:
    async with LogApp().run_test(size=(80, 12)) as pilot:
        await shown(pilot, lines(1, 3))
        app = pilot.app
        assert isinstance(app, LogApp)
        for path, words in (
            (tmp_path, "The file already exists"),
            (tmp_path / ("n" * 300), "too long"),
            (Path("/proc/nowhere/x"), ""),
            (Path(), "Enter a file name"),
        ):
            app.pane.save()
            await answer(pilot, path if path != Path() else Path(" "))
            assert words in remark(app)
            assert remark(app)
            await pilot.press("escape")

"""A trial of the walls that was not finished is no answer: nothing is graded without them."""

from __future__ import annotations

import sys

import pytest

from course.grade import walls
from launcher.errors import LauncherError

ENDLESS = (sys.executable, "-c", "import time; time.sleep(600)")


def test_a_trial_that_does_not_end_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(walls, "_TRIED_WITHIN_S", 0.1)
    with pytest.raises(LauncherError, match="too busy; nothing was graded"):
        walls._runs(ENDLESS)


@pytest.mark.parametrize(("code", "holds"), [("0", True), ("1", False)])
def test_one_that_ends_is_the_answer(code: str, holds: bool) -> None:
    assert walls._runs((sys.executable, "-c", f"raise SystemExit({code})")) is holds

"""What there is to read of a step: what it explains, and its task, drawn from Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from rich.markdown import CodeBlock, Markdown
from rich.padding import Padding
from rich.syntax import Syntax

from course.lessons.lesson import Texts
from launcher.errors import LauncherError
from text.i18n import language, localized
from text.plain import plain_lines
from text.sentences import reason_of

if TYPE_CHECKING:
    from rich.console import Console, ConsoleOptions, RenderResult
    from rich.markdown import MarkdownElement

    from course.lessons.lesson import LessonFolder

MOST_PINNED = 8
"""Lines of a task that stay on the screen; a longer one is read below what is explained."""


class StepTexts:
    """The texts of one lesson in the current language."""

    def __init__(self, lesson: LessonFolder) -> None:
        self._lesson = lesson
        self._texts = Texts("", {})
        self._language = ""

    def explained(self, step: str) -> str:
        """Return what stands before the task, as Markdown; for the first step, with a preface."""
        texts = self._read()
        parts = [texts.explained(step)]
        if self._lesson.steps[0].id == step:
            parts.insert(0, texts.introduction)
        if not self._fits(texts.task(step)):
            parts.append(texts.task(step))
        return "\n\n".join(filter(None, parts))

    def task(self, step: str) -> str:
        """Return what is to be done, as Markdown; empty if it is too long to stay in sight."""
        task = self._read().task(step)
        return task if self._fits(task) else ""

    @staticmethod
    def _fits(task: str) -> bool:
        return len(task.splitlines()) <= MOST_PINNED

    def _read(self) -> Texts:
        """Return the texts, or in their place why there are none."""
        if self._language != language():
            self._language = language()
            try:
                self._texts = self._lesson.texts(self._language)
            except LauncherError as error:
                self._texts = Texts(localized(reason_of(error)), {})
        return self._texts


class _Code(CodeBlock):
    """Code without the blank lines that Rich puts above and below it."""

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Draw it, two columns from the left."""
        del console, options
        code = Syntax(str(self.text).rstrip(), self.lexer_name, theme=self.theme, word_wrap=True)
        yield Padding(code, (0, 0, 0, 2))


class _Drawn(Markdown):
    elements: ClassVar[dict[str, type[MarkdownElement]]] = {**Markdown.elements, "fence": _Code, "code_block": _Code}


def drawn(text: str, *, dark: bool) -> Markdown:
    """Return Markdown to be shown on a dark or a light background."""
    theme = "ansi_dark" if dark else "ansi_light"
    return _Drawn(plain_lines(text), code_theme=theme, hyperlinks=False)

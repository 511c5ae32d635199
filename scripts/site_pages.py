"""What the site shows beyond the files of docs/: a hook of MkDocs, named in mkdocs.yml.

The tables are made of what the program announces, in the language of the page. A page asks for one by a comment:
`<!-- keys: deck -->` for the actions that are defined in `tui.deck`, `<!-- commands -->` for the command line,
`<!-- lessons -->` for the lessons. A page that is nothing but a link to a file beside docs/ shows that file.
"""

from __future__ import annotations

import argparse
import html
import posixpath
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

ROOT = Path(__file__).resolve().parents[1]
# MkDocs loads this file by its path, and only `make` has installed the rooms.
if str(ROOT) not in sys.path:
    sys.path.insert(0, str(ROOT))

from textual.app import App  # noqa: E402
from textual.binding import Binding  # noqa: E402

from cli.commands import COMMANDS, OPEN, parser_of, speak  # noqa: E402
from launcher.profile.catalog import list_profiles  # noqa: E402
from text.i18n import _, pick, set_language  # noqa: E402
from tui.actions import REGISTRY  # noqa: E402
from tui.screens import every_action  # noqa: E402

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from mkdocs.structure.files import File, Files
    from mkdocs.structure.pages import Page

TABLE = re.compile(r"^<!-- (keys|commands|lessons)(?:: ([\w ]+))? -->$", re.MULTILINE)
STANDS_FOR = re.compile(r"\s*\[[^\]]*\]\(\.\./([\w.]+\.md)\)\s*")
LINK = re.compile(r"(?<!!)\[([^\]]*)\]\(([^)\s:]+)\)")
PICTURE = re.compile(r"!\[([^\]]*)\]\(([^)\s:]+)\)")
HEADS = {
    "en": {
        "keys": ("key", "action", "what it does"),
        "lessons": ("lesson", "title", "what it shows"),
        "options": ("option", "what it does"),
    },
    "ru": {
        "keys": ("клавиша", "действие", "что делает"),
        "lessons": ("урок", "название", "что в нём"),
        "options": ("параметр", "что делает"),
    },
}


def on_page_markdown(markdown: str, page: Page, files: Files, **_more: object) -> str:
    """Put the tables in, take a file from beside docs/, and turn links to what stands there."""
    source = f"docs/{page.file.src_uri}"
    if shown := STANDS_FOR.fullmatch(markdown):
        source = shown[1]
        markdown = (ROOT / source).read_text("utf-8")
    pages = {f"docs/{file.src_uri}": file.src_uri for file in files}
    pages |= {beside: file.src_uri for file in files if (beside := _stands_for(file))}
    language = page.file.locale
    turned = _turn_links(markdown, source, page.file.src_uri, pages)
    return TABLE.sub(lambda found: table(found[1], found[2] or "", language), turned)


def _stands_for(file: File) -> str:
    """Return the file beside docs/ that a page shows."""
    shown = STANDS_FOR.fullmatch(file.content_string) if file.is_documentation_page() else None
    return shown[1] if shown else ""


def _turn_links(markdown: str, source: str, here: str, pages: dict[str, str]) -> str:
    """Make links between files of the repository links between pages; where there is no page, leave the words."""
    folder = posixpath.dirname(source)

    def place(target: str) -> str:
        path, hash_, anchor = target.partition("#")
        page = pages.get(posixpath.normpath(posixpath.join(folder, path)))
        return "" if page is None else posixpath.relpath(page, posixpath.dirname(here) or ".") + hash_ + anchor

    def turned(found: re.Match[str]) -> str:
        words, target = found[1], found[2]
        if target.startswith("#"):
            return found[0]
        # The site has a switch for the language.
        if words in ("По-русски", "In English"):
            return ""
        return f"[{words}]({there})" if (there := place(target)) else words

    markdown = PICTURE.sub(lambda found: f"![{found[1]}]({place(found[2])})", markdown)
    return LINK.sub(turned, markdown)


def table(kind: str, of: str, language: str) -> str:
    """Return a table in Markdown."""
    set_language(language)
    heads = HEADS[language]
    if kind == "keys":
        return _rows(heads["keys"], _keys(of))
    if kind == "lessons":
        profiles = [entry for entry in list_profiles() if not entry.error]
        return _rows(heads["lessons"], ((f"`{each.name}`", pick(each.title), pick(each.about)) for each in profiles))
    speak()
    return "\n\n".join(_command(name, heads["options"]) for name in (OPEN, *COMMANDS))


def _keys(rooms: str) -> Iterable[tuple[str, str, str]]:
    every_action()
    app: App[None] = App()

    def written(key: str) -> str:
        return _("space") if key == "space" else html.escape(app.get_key_display(Binding(key, "")))

    for each in REGISTRY.values():
        if each.module.split(".")[1] in rooms.split():
            keys = " ".join(f"<kbd>{written(key)}</kbd>" for key in each.key.split(","))
            yield keys, _(each.title), _(each.tooltip)


def _command(name: str, heads: tuple[str, ...]) -> str:
    parser = parser_of(name)
    options = [each for each in parser._actions if each.help is not argparse.SUPPRESS]  # noqa: SLF001
    rows = ((f"`{_written(each)}`", (each.help or "") % {"prog": parser.prog}) for each in options)
    words = [f"## {parser.prog}", parser.description or "", _rows(heads, rows)]
    if name != OPEN:
        words.append(parser.epilog or "")
    return "\n\n".join(filter(None, words))


def _written(option: argparse.Action) -> str:
    value = option.metavar or (f"{{{','.join(map(str, option.choices))}}}" if option.choices else "")
    if not option.option_strings:
        return str(value or option.dest)
    return ", ".join(option.option_strings) + (f" {value}" if value and option.nargs != 0 else "")


def _rows(heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    lines = [heads, ["---"] * len(heads), *([cell.replace("|", "\\|") for cell in row] for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)

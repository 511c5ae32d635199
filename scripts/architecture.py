"""List the rooms for ARCHITECTURE.md from the code: `architecture.py [--write]`.

What a room is for is the first sentence of its docstring; the imports are read from its modules. Without --write the
list goes to standard output.
"""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import grimp
from importlinter.application.use_cases import read_user_options
from importlinter.configuration import configure

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "ARCHITECTURE.md"
BEGIN, END = "<!-- scripts/architecture.py: begin -->\n", "<!-- scripts/architecture.py: end -->\n"
OUR_OWN_MESSAGES = ("ackermann_msgs", "composition_interfaces", "deck_interfaces", "example_interfaces", "tf2_msgs")

NOT_WORTH_NAMING = ("backports", "compression", "mcp_types", "pydantic_core", "typing_extensions")
"""Parts of libraries that are named, and of newer Pythons."""


def rooms_table() -> str:
    """Return the rooms in Markdown, each with what it is for and what its modules import."""
    configure()
    options = read_user_options(str(ROOT / "pyproject.toml"))
    rooms = [str(room) for room in options.session_options["root_packages"]]
    sys.path.insert(0, str(ROOT))
    graph = grimp.build_graph(*rooms, include_external_packages=True, cache_dir=None)
    # `python -m tui` is another name for the command line; the screen does not depend on it.
    for program in [module for module in graph.modules if module.endswith(".__main__")]:
        graph.remove_module(program)
    for room in rooms:
        graph.squash_module(room)
    rows = ["| room | what it is for | imports | libraries |", "| --- | --- | --- | --- |"]
    known = {*rooms, *sys.stdlib_module_names, *NOT_WORTH_NAMING}
    for room in rooms:
        imported = graph.find_modules_directly_imported_by(room)
        others = sorted((imported & {*rooms}) - {room})
        libraries = sorted({_library(name) for name in imported - known}, key=str.lower)
        rows.append(f"| {room} | {_purpose(room)} | {', '.join(others)} | {', '.join(libraries)} |")
    return "\n".join(rows) + "\n"


def _purpose(room: str) -> str:
    docstring = ast.get_docstring(ast.parse((ROOT / room / "__init__.py").read_text("utf-8"))) or ""
    return " ".join(docstring.partition("\n\n")[0].split()).rstrip(".")


def _library(name: str) -> str:
    ros = name.endswith(("_msgs", "_interfaces", "_srvs"))
    return "ROS messages" if ros or name in OUR_OWN_MESSAGES else name


def page(text: str) -> str:
    """Return ARCHITECTURE.md with the current list in place of the one in `text`."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{rooms_table()}\n{END}{after}"


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(page(PAGE.read_text("utf-8")), "utf-8")
    else:
        print(rooms_table(), end="")

"""Draw the rooms for ARCHITECTURE.md from the code: `architecture.py [--write]`.

The imports are read from the modules, the layers within a room from the contracts in
pyproject.toml. Without --write the picture goes to standard output.
"""

from __future__ import annotations

import sys
from pathlib import Path

import grimp
from importlinter.application.use_cases import read_user_options
from importlinter.application.user_options import UserOptions
from importlinter.configuration import configure

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "ARCHITECTURE.md"
BEGIN, END = "<!-- scripts/architecture.py: begin -->\n", "<!-- scripts/architecture.py: end -->\n"
OUR_OWN_MESSAGES = ("ackermann_msgs", "composition_interfaces", "deck_interfaces", "example_interfaces", "tf2_msgs")


def picture() -> str:
    """Return the picture in Markdown."""
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
    imported = {room: sorted(graph.find_modules_directly_imported_by(room)) for room in rooms}
    parts = [_arrows(imported, rooms), _libraries(imported, rooms), *_layers(options)]
    return "\n".join(parts)


def _arrows(imported: dict[str, list[str]], rooms: list[str]) -> str:
    arrows = [
        f"    {room} --> {other}\n" for room in rooms for other in imported[room] if other in rooms and other != room
    ]
    return f"```mermaid\nflowchart TD\n{''.join(arrows)}```\n"


def _libraries(imported: dict[str, list[str]], rooms: list[str]) -> str:
    known = {*rooms, *sys.stdlib_module_names, "typing_extensions"}
    rows = []
    for room in rooms:
        names = {_library(name) for name in imported[room] if name not in known}
        rows.append(f"| {room} | {', '.join(sorted(names, key=str.lower)) or '-'} |\n")
    return f"| room | libraries it imports itself |\n| --- | --- |\n{''.join(rows)}"


def _library(name: str) -> str:
    ros = name.endswith(("_msgs", "_interfaces", "_srvs"))
    return "ROS messages" if ros or name in OUR_OWN_MESSAGES else name


def _layers(options: UserOptions) -> list[str]:
    drawn = []
    for contract in options.contracts_options:
        if contract["type"] != "layers":
            continue
        (room,) = contract["containers"]
        layers = [f"  {str(layer).strip('()')}\n" for layer in contract["layers"]]
        drawn.append(f"```text\n{room}\n{''.join(layers)}```\n")
    return drawn


def page(text: str) -> str:
    """Return ARCHITECTURE.md with the current picture in place of the one in `text`."""
    before, _, rest = text.partition(BEGIN)
    _, _, after = rest.partition(END)
    return f"{before}{BEGIN}\n{picture()}\n{END}{after}"


if __name__ == "__main__":
    if sys.argv[1:] == ["--write"]:
        PAGE.write_text(page(PAGE.read_text()))
    else:
        print(picture(), end="")

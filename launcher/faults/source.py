"""Looking at a learner's file without running it: does it compile, is what it imports installed?"""

from __future__ import annotations

import ast
import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.faults.rules.imports import missing_import
from launcher.faults.rules.syntax import encoding_of, syntax
from launcher.status import IDLE, NodeFault
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

MAX_BYTES = 1 << 20
MAIN = "main"
WAITING = {"create_timer", "create_subscription", "create_service", "ActionServer"}
"""What only works while the node is spun."""


def look_at(file: str) -> NodeFault | None:
    """Return what is wrong with a Python file, None if nothing can be seen."""
    path = Path(file)
    try:
        data = path.read_bytes()[:MAX_BYTES]
    except OSError as error:
        return NodeFault("import", file, exception=plain(str(error)))
    try:
        tree = compile(data, file, "exec", ast.PyCF_ONLY_AST, dont_inherit=True)
        compile(data, file, "exec", dont_inherit=True)
    except SyntaxError as error:
        return _syntax(file, error, data)
    except (ValueError, RecursionError, MemoryError) as error:  # A NUL character, or nested deeply
        meaning = encoding_of(data) or ""
        return NodeFault("syntax", file, exception=plain(str(error)), meaning=meaning)
    lines = data.decode("utf-8", "replace").splitlines()
    assert isinstance(tree, ast.Module)
    for name, node in _imports(tree):
        if not _is_there(name, path.parent):
            return _missing(file, name, node, lines)
    return None


def unspun(file: str) -> NodeFault | None:
    """Return why a node's program ended by itself: nothing calls main, or nothing spins."""
    tree, _lines = _read(file)
    named = {getattr(node, "id", getattr(node, "attr", "")) for node in ast.walk(tree)}
    mains = [each for each in tree.body if isinstance(each, ast.FunctionDef) and each.name == MAIN]
    if "rclpy" not in {name for name, _node in _imports(tree)}:
        return None
    ended = say("the program came to its end")
    if mains and MAIN not in named:
        words = say('main() is never called: if __name__ == "__main__": main().')
        return NodeFault(IDLE, file, mains[0].lineno, exception=ended, meaning=words)
    if not any(name.startswith("spin") for name in named):
        line = mains[0].end_lineno if mains else tree.body[-1].end_lineno
        words = say("rclpy.spin(node) is missing: it keeps the node running.")
        kind = IDLE if named & WAITING else "warning"
        return NodeFault(kind, file, line or 0, exception=ended, meaning=words)
    return None


def _read(file: str) -> tuple[ast.Module, list[str]]:
    """Return a program and its lines; nothing if it cannot be read."""
    try:
        data = Path(file).read_bytes()[:MAX_BYTES]
        return ast.parse(data), data.decode("utf-8", "replace").splitlines()
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return ast.Module([], []), []


def modules_of(file: str) -> set[str]:
    """Return the files of the same folder that it imports, and that those import."""
    found: set[str] = set()
    pending = [Path(file)]
    while pending:
        path = pending.pop()
        names = {name for name, _node in _imports(_read(str(path))[0], deep=True)}
        beside = {str(path.with_name(f"{name}.py")) for name in names} - found
        pending += [Path(each) for each in beside if Path(each).is_file()]
        found |= beside
    return found - {file}


def _syntax(file: str, error: SyntaxError, data: bytes) -> NodeFault:
    words = plain(f"{type(error).__name__}: {error.msg}")
    return NodeFault(
        "syntax",
        file,
        line=error.lineno or 0,
        column=error.offset or 0,
        source_line=plain((error.text or "").strip()),
        exception=words,
        meaning=encoding_of(data) or syntax(error, data.decode(errors="replace").splitlines()),
    )


def _imports(tree: ast.Module, *, deep: bool = False) -> Iterator[tuple[str, ast.stmt]]:
    """Yield the top-level names of the modules that the file imports when it is run.

    `deep`: and of those that it imports within functions.
    """
    for node in ast.walk(tree) if deep else tree.body:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name.partition(".")[0], node
        elif isinstance(node, ast.ImportFrom) and not node.level and node.module:
            yield node.module.partition(".")[0], node


def _is_there(name: str, folder: Path) -> bool:
    if name in sys.builtin_module_names or name in sys.stdlib_module_names:
        return True
    if (folder / f"{name}.py").is_file() or (folder / name).is_dir():
        return True
    try:
        return importlib.util.find_spec(name) is not None
    except (ImportError, ValueError):
        return False


def _missing(file: str, name: str, node: ast.stmt, lines: list[str]) -> NodeFault:
    return NodeFault(
        "import",
        file,
        line=node.lineno,
        column=node.col_offset + 1,
        source_line=plain(lines[node.lineno - 1].strip()),
        exception=f"ModuleNotFoundError: No module named '{plain(name)}'",
        meaning=missing_import(name, node, file.rpartition("/")[0]),
    )


_BEGINS = ("init", "try_shutdown", "shutdown")
"""What ends one life of ROS in a process, or begins another, in which a node may be spun anew."""


def spun_in_turn(file: str) -> NodeFault | None:
    """Return the fault of a program whose `rclpy.spin` keeps another one from its turn."""
    tree, lines = _read(file)
    for node in ast.walk(tree):
        line = _second(list(_straight(node.body))) if isinstance(node, (ast.Module, ast.FunctionDef)) else 0
        if line:
            meaning = say(
                "rclpy.spin does not return while the node before it runs: give both to one executor,"
                " executor = MultiThreadedExecutor(), executor.add_node(node) for each, and"
                " executor.spin() once."
            )
            exception = say("the turn of this node does not come")
            return NodeFault("warning", file, line, 0, plain(lines[line - 1].strip()), exception, meaning)
    return None


def _straight(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements that are run one after the other, whatever happens."""
    for statement in body:
        yield statement
        if isinstance(statement, (ast.With, ast.Try)):
            yield from _straight(statement.body)


def _second(statements: list[ast.stmt]) -> int:
    """Return the line of the spin whose turn does not come, 0 if there is none."""
    first = ""
    for statement in statements:
        if isinstance(statement, ast.For):
            each = ast.unparse(statement.target)
            turns = (inner.lineno for inner in statement.body if _spun(inner) == each)
            if line := next(turns, 0):
                return line
        if isinstance(statement, ast.Expr) and _called(statement.value) in _BEGINS:
            first = ""
        node = _spun(statement)
        if node and first and node != first:
            return statement.lineno
        first = first or node
    return 0


def _spun(statement: ast.stmt) -> str:
    """Return the node that `rclpy.spin(node)` is given, empty if it is something else."""
    call = statement.value if isinstance(statement, ast.Expr) else None
    if not isinstance(call, ast.Call) or len(call.args) != 1 or call.keywords:
        return ""
    return ast.unparse(call.args[0]) if _called(call) == "spin" else ""


def _called(call: ast.AST) -> str:
    func = call.func if isinstance(call, ast.Call) else None
    if isinstance(func, ast.Attribute):
        of = func.value
        return func.attr if isinstance(of, ast.Name) and of.id == "rclpy" else ""
    return func.id if isinstance(func, ast.Name) else ""

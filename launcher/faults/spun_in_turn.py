"""A program that spins one node after the other: the second one never runs."""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING

from launcher.faults.source import MAX_BYTES
from launcher.status import NodeFault
from text.plain import plain
from text.sentences import say

if TYPE_CHECKING:
    from collections.abc import Iterator

_BEGINS = ("init", "try_shutdown", "shutdown")
"""What ends one life of ROS in a process, or begins another, in which a node may be spun anew."""


def spun_in_turn(file: str) -> NodeFault | None:
    """Return the fault of a program whose `rclpy.spin` keeps another one from its turn."""
    try:
        data = Path(file).read_bytes()[:MAX_BYTES]
        tree = ast.parse(data)
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return None
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.FunctionDef)):
            line = _second(list(_straight(node.body)))
            if line:
                return _fault(file, line, data.decode("utf-8", "replace").splitlines())
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


def _fault(file: str, line: int, lines: list[str]) -> NodeFault:
    return NodeFault(
        "warning",
        file,
        line,
        source_line=plain(lines[line - 1].strip()),
        exception=say("the turn of this node does not come"),
        meaning=say(
            "rclpy.spin does not return while the node before it runs: give both to one executor,"
            " executor = MultiThreadedExecutor(), executor.add_node(node) for each, and"
            " executor.spin() once."
        ),
    )

"""Lines that Python cannot read, and a file looked at without running it: does it compile, is all installed?"""

from __future__ import annotations

import ast
import codecs
import importlib.util
import keyword
import re
import sys
from collections.abc import Iterator
from pathlib import Path

from launcher.faults.rules.names import missing_import, mixed
from launcher.status import IDLE, NodeFault
from text.i18n import N_
from text.plain import plain
from text.sentences import Words, say

_QUOTES = "“”„‟‘’‚‛«»`´″′"
_OTHER_SIGNS = {
    "–": "-", "—": "-", "−": "-", "×": "*", "·": "*", "÷": "/", "≤": "<=", "≥": ">=", "≠": "!=",
    "（": "(", "）": ")", "，": ",", "：": ":", "；": ";", "…": "...", "№": "#", "→": "->",
}  # fmt: skip
_INVISIBLE = "\u00a0\u2007\u202f\u200b\u200c\u200d\ufeff\u3000"
_AND = N_("In Python it is written and, or, not.")
_UNENDED = N_("A quotation mark is missing at the end of a text.")
_UNCLOSED = N_("A bracket is opened in this line and never closed.")
_EQUALS = N_("A comparison has two equals signs: ==.")
_PRINT = N_('print is a function: print("…"), in round brackets.')
_LOOP = N_("break and continue belong into a loop: is the line indented deep enough?")
_DEFAULTS = N_("Arguments with a default, x=1, come after those without.")
ROWS = (
    ("", r"^\s*(```|~~~)", N_("The line ``` is of the text that this was copied from: delete it.")),
    ("", r"^\s*(>>>(?!>)|\$ |In \[)",
     N_("The sign in front of the line is the prompt that was copied with it: delete it.")),
    ("", r"^\s*(<{7}|={7}|>{7})",
     N_("git has marked a conflict here: choose one of the two, and delete the marks.")),
    ("inconsistent use of tabs", "", N_("Tabs and blanks are mixed: indent with four blanks a level, and no tabs.")),
    ("unindent does not match", "",
     N_("This line is as deep as none of the lines above: four blanks a level.")),
    ("unexpected indent", "",
     N_("This line is deeper than the one above, and nothing is opened there: take blanks away in front of it.")),
    ("", r"^\s*for\s*\(.*;.*;", N_("A loop that counts is written for i in range(3):.")),
    ("", r"\+\+|--", N_("Python has no ++ and --: write x += 1.")),
    ("", r"&&|\|\||(^|[\s(])!(?!=)", _AND),
    ("", r"^\s*(//|/\*)", N_("A comment begins with #.")),
    ("", r"^\s*(def|class|if|for|while)\b.*\{\s*$",
     N_("A block begins with a colon and is indented; there are no curly brackets.")),
    ("", r"^\s*(var|let|const|int|float|double|string|auto)\s+\w+\s*=",
     N_("A variable is made without its type: x = 1.")),
    ("", r"^\s*(function|func|void)\b", N_("A function begins with def: def main():.")),
    ("", r"^\s*print\s+\S", _PRINT),
    ("", r"^\s*else\s+if\b", N_("In Python else if is one word: elif.")),
    ("expected ':'|invalid syntax",
     r"^\s*(def|class|if|elif|else|for|while|try|except|finally|with|async)\b(?=[^()]*(\(.*\)[^()]*)?$).*(?<![:\s])\s*$",
     N_("A line with def, class, if, else, for, while, try or with ends in a colon.")),
    ("was never closed", "", _UNCLOSED),
    ("does not match opening", "",
     N_("The brackets do not fit: one is closed with a sign of another kind.")),
    ("unmatched", "", N_("Here a bracket is closed that nobody has opened.")),
    ("unterminated triple-quoted", "", N_('A text that begins with """ has to end with """.')),
    ("unterminated|EOL while scanning", "", _UNENDED),
    ("expected 'except'", "", N_("A try needs an except, or a finally, at the same depth.")),
    ("in call to 'print'", "", _PRINT),
    ("in call to '(?P<name>\\w+)'", "", N_("{name} is a function: {name}(…), in round brackets.")),
    ("cannot assign to|Maybe you meant '=='", r"^\s*(if|elif|while|assert)\b", _EQUALS),
    ("cannot assign to", "",
     N_("Left of = stands the name that is to get the value; a comparison has two: ==.")),
    ("forgot a comma", "", N_("Between two values a comma is missing.")),
    ("positional argument follows keyword", "",
     N_("Arguments with a name, x=1, come after those without.")),
    ("non-default argument follows|without a default follows", "", _DEFAULTS),
    ("outside function", "", N_("This belongs into a function: is the line indented deep enough?")),
    ("outside async function", "", N_("await only goes in async def.")),
    ("outside loop|not properly in loop", "", _LOOP),
    ("leading zeros", "", N_("A number does not begin with a 0: 7, not 07.")),
    ("invalid decimal literal", "",
     N_("A name does not begin with a digit, and a number has no unit: 0.5, not 0.5s.")),
    ("after line continuation", "",
     N_("After \\ the line has to end: in a text, a \\ is written twice.")),
    ("unicodeescape", "", N_('In a text \\ has a meaning of its own: write r"C:\\…", or /.')),
    ("^f-string", "",
     N_("In the curly brackets of an f-string stands an expression, and other quotes than around it.")),
    ("(used prior|assigned to before) .*global", "", N_("global comes first in a function.")),
    ("expected '\\('", r"^\s*def\s+\w", N_("Behind the name of a function come brackets: def main():.")),
    ("", r"^\s*(if|for|while|with|def|class)\b.*\([^)]*:$", _UNCLOSED),
    ("", r"===|!==", N_("Equal is written ==, and not equal !=.")),
    ("", r"=<|=>", N_("At most is written <=, at least >=: the equals sign comes last.")),
    ("", r"\w->\w", N_("In Python a point stands there, as in self.x, not ->.")),
    ("", r"(^|[\s=(])new\s+\w+\s*\(", N_('An object is made without new: Node("name").')),
    ("", r"^\s*switch\b", N_("Instead of switch Python has if, elif and else.")),
    ("", r"^\s*catch\b", N_("What catches an exception is called except.")),
    ("", r"^\s*except\s+\w+(\s+\w+\s*:|\s*,)",
     N_("The name of the exception comes behind as: except Exception as error:.")),
    ("", r"^\s*(if|while)\b.*\bthen\b", N_("Python has no then: behind the condition comes a colon.")),
    ("", r"^\s*import\s+([\w.]+\s+)?from\b",
     N_("It is the other way round: from rclpy.node import Node.")),
    ("", r"^\s*(import|from)\s+\w+/",
     N_("A module is named with points, not with /: from std_msgs.msg import String.")),
    ("", r"^\s*def\s+\w+\(.*\b(int|float|str|string|double|bool)\s+\w+",
     N_("An argument is written without its type, or with a colon: def f(x: int):.")),
    ("", r"^\s*(public|private|static)\b",
     N_("Python has no public, private and static: leave the word out.")),
    ("", r"^\s*(assert|if|elif|while)\b[^=!<>(]*[^=!<>(]=[^=]", _EQUALS),
    ("", r"(\band|\bor|\bnot|[-+*/%=])\s*$",
     N_("The line ends in the middle: something is missing at its end.")),
    ("", r"^\s*(?P<word>else|elif|except|finally)\b",
     N_("{word} belongs to an if, for or try at the same depth, directly below its block.")),
    ("indent", "", N_("The indentation is wrong: four blanks a level, and no tabs.")),
    ("", "", N_("Python cannot read this line; the mistake may also be in the line above.")),
)  # fmt: skip
"""In order: a part of what Python says, what stands in the line (texts and comment taken out), what it means."""


def encoding_of(data: bytes) -> Words | None:
    """Say that a file is not stored as UTF-8; None if it is."""
    is_wide = len(data) > 3 and data[:2].count(0) == 1 and data[:200].count(0) >= len(data[:200]) // 3
    if is_wide or data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return say("The file is stored as UTF-16: save it as UTF-8, in the editor's Save As.")
    if b"\0" in data:
        return say("The file has zero bytes in it: it is not a text, or was not written to its end.")
    try:
        data.decode()
    except UnicodeDecodeError as error:
        if re.match(rb"[^\n]*(\n[^\n]*)?coding[:=]\s*[-\w.]+", data):
            return None
        phrase = N_("The file is not stored as UTF-8 (line {line}): save it as UTF-8, in the editor's Save As.")
        return say(phrase, line=data[: error.start].count(b"\n") + 1)
    return None


def syntax(error: SyntaxError, lines: list[str]) -> Words:
    """Return the sentence for a syntax error; `lines`: of the file."""
    number = error.lineno or 0
    line = lines[number - 1] if 0 < number <= len(lines) else (error.text or "")
    code, said = re.sub(r"\"[^\"]*\"|'[^']*'", '""', line).partition("#")[0].rstrip(), str(error.msg)
    words = _signs(line, code, said) or _below(said, lines) or _keyword(code)
    for part, stands, sentence in ROWS if words is None else ():
        told, found = re.search(part, said), re.search(stands, code)
        if told and found:
            return say(sentence, **told.groupdict(), **found.groupdict())
    assert words is not None  # The last row fits all.
    return words


def _signs(line: str, code: str, said: str) -> Words | None:
    quotes = [each for each in code if each in _QUOTES and not code.lstrip().startswith("```")]
    if quotes:
        phrase = N_("The quotes {signs} are those of a text processor: Python has \" and '.")
        return say(phrase, signs="".join(dict.fromkeys(quotes)))
    sign = next((each for each in code if each in _OTHER_SIGNS), "")
    if sign:
        return say(
            "The sign {sign} is that of a text processor: Python has {meant}.", sign=sign, meant=_OTHER_SIGNS[sign]
        )
    if "non-printable" in said and any(each in line for each in _INVISIBLE):
        return say("In this line is an invisible sign, as copying from a page brings along: type its blanks again.")
    names = (each for each in re.findall(r"[^\W\d]\w*", code) if not each.isascii())
    return next((words for each in names if (words := mixed(each)) is not None), None)


def _below(said: str, lines: list[str]) -> Words | None:
    """Say that nothing is indented below a line that opens a block."""
    opened = re.search(r"expected an indented block.* on line (\d+)", said)
    if not opened or not 0 < int(opened[1]) <= len(lines):
        return None
    above = lines[int(opened[1]) - 1].strip()
    if not any(each.strip() for each in lines[int(opened[1]) :]):
        return say("Below {above!r} nothing stands: what belongs to it is indented; pass does nothing.", above=above)
    return say("The lines below {above!r} have to be indented, four blanks deeper.", above=above)


def _keyword(code: str) -> Words | None:
    """Say that a word of Python itself was taken for a name."""
    names = re.findall(r"\.([a-z]+)\b|\bdef\s+([a-z]+)\s*\(|^\s*([a-z]+)\s*=(?!=)", code)
    word = next((each for found in names for each in found if keyword.iskeyword(each)), "")
    if word in ("", "lambda", "not", "await", "yield", "return", "if", "while", "elif", "assert"):
        return None
    return say("{word} is a word of Python itself: take another name, {word}_.", word=word)


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

"""Lines that Python cannot read: what stands there, seen with the eyes of a beginner."""

from __future__ import annotations

import codecs
import keyword
import re
from typing import TYPE_CHECKING

from launcher.faults.rules.names import mixed
from text.i18n import N_
from text.sentences import say

if TYPE_CHECKING:
    from text.sentences import Words

QUOTES = "“”„‟‘’‚‛«»`´″′"
OTHER_SIGNS = {
    "–": "-", "—": "-", "−": "-", "×": "*", "·": "*", "÷": "/", "≤": "<=", "≥": ">=", "≠": "!=",
    "（": "(", "）": ")", "，": ",", "：": ":", "；": ";", "…": "...", "№": "#", "→": "->",
}  # fmt: skip
_MARKS = ("<<<<<<<", "=======", ">>>>>>>")
_BLOCK = re.compile(r"\s*(def|class|if|elif|else|for|while|try|except|finally|with|async)\b")
_MESSAGES = (
    ("unindent does not match", N_("This line is as deep as none of the lines above: four"
        " blanks a level.")),
    ("unexpected indent", N_("This line is deeper than the one above, and nothing is"
        " opened there: take blanks away in front of it.")),
    ("was never closed", N_("A bracket is opened in this line and never closed.")),
    ("unexpected EOF", N_("A bracket or a block is opened and never closed.")),
    ("does not match opening", N_("The brackets do not fit: one is closed with a sign of"
        " another kind.")),
    ("unmatched", N_("Here a bracket is closed that nobody has opened.")),
    ("unterminated triple-quoted", N_('A text that begins with """ has to end with """.')),
    ("unterminated", N_("A quotation mark is missing at the end of a text.")),
    ("EOL while scanning", N_("A quotation mark is missing at the end of a text.")),
    ("expected 'except'", N_("A try needs an except, or a finally, at the same depth.")),
    ("Missing parentheses in call", N_('print is a function: print("…"), in round brackets.')),
    ("cannot assign to", N_("Left of = stands the name that is to get the value; a"
        " comparison has two: ==.")),
    ("Maybe you meant '=='", N_("A comparison has two equals signs: ==.")),
    ("forgot a comma", N_("Between two values a comma is missing.")),
    ("positional argument follows keyword", N_("Arguments with a name, x=1, come after"
        " those without.")),
    ("non-default argument follows", N_("Arguments with a default, x=1, come after those"
        " without.")),
    ("without a default follows", N_("Arguments with a default, x=1, come after those without.")),
    ("outside function", N_("This belongs into a function: is the line indented deep enough?")),
    ("outside async function", N_("await only goes in async def.")),
    ("outside loop", N_("break and continue belong into a loop: is the line indented deep"
        " enough?")),
    ("not properly in loop", N_("break and continue belong into a loop: is the line"
        " indented deep enough?")),
    ("leading zeros", N_("A number does not begin with a 0: 7, not 07.")),
    ("invalid decimal literal", N_("A name does not begin with a digit, and a number has"
        " no unit: 0.5, not 0.5s.")),
    ("keyword argument repeated", N_("An argument is given twice.")),
    ("duplicate argument", N_("Two arguments have the same name.")),
    ("after line continuation", N_("After \\ the line has to end: in a text, a \\ is"
        " written twice.")),
    ("unicodeescape", N_('In a text \\ has a meaning of its own: write r"C:\\…", or /.')),
    ("f-string", N_("In the curly brackets of an f-string stands an expression, and other"
        " quotes than around it.")),
    ("used prior to global", N_("global comes first in a function.")),
    ("assigned to before global", N_("global comes first in a function.")),
    ("expected '('", N_("Behind the name of a function come brackets: def main():.")),
)  # fmt: skip
"""Parts of what Python says itself; a syntax error has no other sign of its kind than its text."""


def encoding_of(data: bytes) -> Words | None:
    """Say that a file is not stored as UTF-8; None if it is."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) or _is_wide(data):
        return say("The file is stored as UTF-16: save it as UTF-8, in the editor's Save As.")
    if b"\0" in data:
        return say("The file has zero bytes in it: it is not a text, or was not written to its end.")
    try:
        data.decode()
    except UnicodeDecodeError as error:
        if re.match(rb"[^\n]*(\n[^\n]*)?coding[:=]\s*[-\w.]+", data):
            return None
        return say(
            "The file is not stored as UTF-8 (line {line}): save it as UTF-8, in the editor's Save As.",
            line=data[: error.start].count(b"\n") + 1,
        )
    return None


def _is_wide(data: bytes) -> bool:
    """Whether it is UTF-16 without a mark: every other byte is zero."""
    return len(data) > 3 and data[:2].count(0) == 1 and data[:200].count(0) >= len(data[:200]) // 3


def syntax(error: SyntaxError, lines: list[str]) -> Words:
    """Return the sentence for a syntax error; `lines`: of the file."""
    number = error.lineno or 0
    line = lines[number - 1] if 0 < number <= len(lines) else (error.text or "")
    return (
        _copied(line, lines)
        or _signs(line, error)
        or _indentation(error, lines)
        or _counting(line)
        or _of_other_languages(line)
        or _colon(line, error)
        or _keyword(line)
        or _said(error)
        or _habits(line)
        or _depth(line)
        or say("Python cannot read this line; the mistake may also be in the line above.")
    )


def _copied(line: str, lines: list[str]) -> Words | None:
    stripped = line.strip()
    if stripped.startswith(("```", "~~~")) or any(each.startswith("```") for each in lines[:1]):
        return say("The line ``` is of the text that this was copied from: delete it.")
    if stripped.startswith((">>>", "$ ", "In [")) and not stripped.startswith(">>>>>>>"):
        return say("The sign in front of the line is the prompt that was copied with it: delete it.")
    if stripped.startswith(_MARKS) and stripped[:7] in _MARKS:
        return say("git has marked a conflict here: choose one of the two, and delete the marks.")
    return None


def _signs(line: str, error: SyntaxError) -> Words | None:
    code = _without_texts(line)
    quotes = [each for each in code if each in QUOTES]
    if quotes:
        return say(
            "The quotes {signs} are those of a text processor: Python has \" and '.",
            signs="".join(dict.fromkeys(quotes)),
        )
    for sign in code:
        if sign in OTHER_SIGNS:
            return say(
                "The sign {sign} is that of a text processor: Python has {meant}.", sign=sign, meant=OTHER_SIGNS[sign]
            )
    if any(each in line for each in "\u00a0\u2007\u202f\u200b\u200c\u200d\ufeff\u3000") and "non-printable" in str(
        error.msg
    ):
        return say("In this line is an invisible sign, as copying from a page brings along: type its blanks again.")
    for name in re.findall(r"[^\W\d]\w*", code):
        words = mixed(name) if not name.isascii() else None
        if words is not None:
            return words
    return None


def _indentation(error: SyntaxError, lines: list[str]) -> Words | None:
    if isinstance(error, TabError):
        return say("Tabs and blanks are mixed: indent with four blanks a level, and no tabs.")
    if not isinstance(error, IndentationError):
        return None
    above = next((each for each in lines[: (error.lineno or 1) - 1][::-1] if each.strip()), "")
    opened = re.search(r"on line (\d+)", str(error.msg))
    if opened and 0 < int(opened[1]) <= len(lines):
        above = lines[int(opened[1]) - 1]
    if opened and not any(each.strip() for each in lines[int(opened[1]) :]):
        return say(
            "Below {above!r} nothing stands: what belongs to it is indented; pass does nothing.", above=above.strip()
        )
    if "expected an indented block" in str(error.msg):
        return say("The lines below {above!r} have to be indented, four blanks deeper.", above=above.strip())
    return _said(error) or say("The indentation is wrong: four blanks a level, and no tabs.")


def _counting(line: str) -> Words | None:
    """Say how a loop counts that is written as in C."""
    return say(_HABITS[0][1]) if re.match(_HABITS[0][0], line) else None


def _depth(line: str) -> Words | None:
    """Say that an else stands at another depth than its if."""
    found = re.match(r"\s*(else|elif|except|finally)\b", line)
    if not found:
        return None
    return say("{word} belongs to an if, for or try at the same depth, directly below its block.", word=found[1])


def _colon(line: str, error: SyntaxError) -> Words | None:
    if "expected ':'" not in str(error.msg) and "invalid syntax" not in str(error.msg):
        return None
    code = _without_texts(line).partition("#")[0].rstrip()
    if re.match(r"\s*else\s+if\b", code):
        return say("In Python else if is one word: elif.")
    if _BLOCK.match(code) and not code.endswith(":") and code.count("(") == code.count(")"):
        return say("A line with def, class, if, else, for, while, try or with ends in a colon.")
    return None


_HABITS = (
    (r"^\s*for\s*\(.*;.*;", N_("A loop that counts is written for i in range(3):.")),
    (
        r'^(?!\s*(?:if|elif|while|for|with|def|class)\b).*\w\([^{\[]*""\s*:',
        N_("In round brackets a comma or = stands there; a colon belongs in curly brackets."),
    ),
    (r"<>", N_("Not equal is written !=.")),
    (r"===|!==", N_("Equal is written ==, and not equal !=.")),
    (r"=<|=>", N_("At most is written <=, at least >=: the equals sign comes last.")),
    (r"\w->\w", N_("In Python a point stands there, as in self.x, not ->.")),
    (r"(^|[\s=(])new\s+\w+\s*\(", N_('An object is made without new: Node("name").')),
    (r"\?.*:", N_("A choice within a line is written a if condition else b.")),
    (r"^\s*switch\b", N_("Instead of switch Python has if, elif and else.")),
    (r"^\s*catch\b", N_("What catches an exception is called except.")),
    (
        r"^\s*except\s+\w+(\s+\w+\s*:|\s*,)",
        N_("The name of the exception comes behind as: except Exception as error:."),
    ),
    (r"^\s*raise\s+\w+\s*,", N_('An exception is given its text in brackets: raise ValueError("…").')),
    (r"^\s*(if|while)\b.*\bthen\b", N_("Python has no then: behind the condition comes a colon.")),
    (r"lambda[^:]*:\s*return\b", N_("A lambda has no return: its value stands behind the colon.")),
    (r"^\s*import\s+([\w.]+\s+)?from\b", N_("It is the other way round: from rclpy.node import Node.")),
    (r"^\s*from\s+[\w.]+\s+import\s*$", N_("What is to be imported is missing behind import.")),
    (r"^\s*from\s+[\w.]+\s+import\s.*,\s*$", N_("The comma at the end of an import has nothing behind it.")),
    (r"^\s*(import|from)\s+\w+/", N_("A module is named with points, not with /: from std_msgs.msg import String.")),
    (r"^\s*(import|from)\s+\w+-\w", N_("The name of a module has no hyphen in Python: perhaps it is _.")),
    (r"^\s*#?\s*using\s+namespace\b", N_("This line is of C++: Python imports, import rclpy.")),
    (r"^\s*def\s*\(", N_("The function has no name: def main():.")),
    (
        r"^\s*def\s+\w+\(.*\b(int|float|str|string|double|bool)\s+\w+",
        N_("An argument is written without its type, or with a colon: def f(x: int):."),
    ),
    (r"^\s*(public|private|static)\b", N_("Python has no public, private and static: leave the word out.")),
    (r";\s*;", N_("One ; too many: in Python none is needed at the end of a line.")),
    (r"=\s+=|=\s*\+\s*$", N_("The equals sign stands alone here: x = 1, or x += 1.")),
    (r"^\s*(assert|if|elif|while)\b[^=!<>(]*[^=!<>(]=[^=]", N_("A comparison has two equals signs: ==.")),
    (r"\w\.\.\w", N_("Between two names stands one point.")),
    (r"(\band|\bor|\bnot|[-+*/%=])\s*$", N_("The line ends in the middle: something is missing at its end.")),
)
"""What is written otherwise in Python, and how."""


def _habits(line: str) -> Words | None:
    code = _without_texts(line).partition("#")[0].rstrip()
    if _BLOCK.match(code) and code.endswith(":") and code.count("(") > code.count(")"):
        return say("A bracket is opened in this line and never closed.")
    return next((say(words) for part, words in _HABITS if re.search(part, code)), None)


def _of_other_languages(line: str) -> Words | None:
    code = _without_texts(line).partition("#")[0]
    if "++" in code or "--" in code:
        return say("Python has no ++ and --: write x += 1.")
    if "&&" in code or "||" in code:
        return say("In Python it is written and, or, not.")
    if re.search(r"(^|[\s(])!(?!=)", code):
        return say("In Python it is written and, or, not.")
    if re.match(r"\s*(//|/\*)", code):
        return say("A comment begins with #.")
    if re.match(r"\s*(def|class|if|for|while)\b.*\{\s*$", code):
        return say("A block begins with a colon and is indented; there are no curly brackets.")
    if re.match(r"\s*(var|let|const|int|float|double|string|auto)\s+\w+\s*=", code):
        return say("A variable is made without its type: x = 1.")
    if re.match(r"\s*(function|func|void)\b", code):
        return say("A function begins with def: def main():.")
    if re.match(r"\s*print\s+\S", code):
        return say('print is a function: print("…"), in round brackets.')
    return None


def _keyword(line: str) -> Words | None:
    code = _without_texts(line).partition("#")[0]
    found = re.search(r"(?:\.|\bdef\s+|^\s*)([a-z]+)\s*(?:=(?!=)|\(self)", code)
    names = re.findall(r"\.([a-z]+)\b", code) + ([found[1]] if found else [])
    word = next((each for each in names if keyword.iskeyword(each)), "")
    if word and word not in ("lambda", "not", "await", "yield", "return", "if", "while", "elif", "assert"):
        return say("{word} is a word of Python itself: take another name, {word}_.", word=word)
    return None


def _said(error: SyntaxError) -> Words | None:
    message = str(error.msg)
    if message.startswith(("unterminated string", "EOL while")) and _has_mark_inside(error.text or ""):
        return say(
            'A quotation mark is missing at the end of a text, or stands within it: "don\'t" is'
            " written in the other kind of marks."
        )
    if message.startswith("f-string"):
        return say("In the curly brackets of an f-string stands an expression, and other quotes than around it.")
    found = re.search(r"in call to '(\w+)'", message)
    if found and found[1] != "print":
        return say("{name} is a function: {name}(…), in round brackets.", name=found[1])
    return next((say(words) for part, words in _MESSAGES if part in message), None)


def _has_mark_inside(line: str) -> bool:
    """Whether a mark stands within a text that is bounded by the same marks: 'don't'."""
    return re.search(r"'[^']*\w'\w[^']*'", line) is not None


def _without_texts(line: str) -> str:
    return re.sub(r"\"[^\"]*\"|'[^']*'", '""', line)

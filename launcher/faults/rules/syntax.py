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
        return say(
            "The file is not stored as UTF-8 (line {line}): save it as UTF-8, in the editor's Save As.",
            line=data[: error.start].count(b"\n") + 1,
        )
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
        return say(
            "The quotes {signs} are those of a text processor: Python has \" and '.",
            signs="".join(dict.fromkeys(quotes)),
        )
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

"""What is wrong with a YAML text, in words that help whoever typed it."""

from __future__ import annotations

from typing import NoReturn

import yaml

from text.sentences import say
from text.yaml_faults import fault_of


class YamlError(ValueError):
    """A text is no YAML that could be a message; str() is `line:column: what is wrong`."""

    def __init__(self, line: int, column: int, message: str) -> None:
        """Say what is wrong at a place, counted from 1."""
        super().__init__(f"{line}:{column}: {message}")
        self.line = line
        self.column = column
        self.message = message
        """Made by `text.sentences.say`, so that it can be translated."""


def tell_syntax(error: yaml.YAMLError, text: str) -> NoReturn:
    """Raise a YamlError for what PyYAML refuses."""
    if not isinstance(error, yaml.MarkedYAMLError) or error.problem_mark is None:
        _tell_unprintable(error, text)
    mark = error.problem_mark
    lines = text.split("\n")
    content = lines[mark.line] if mark.line < len(lines) else ""
    indent = content[: len(content) - len(content.lstrip())]
    if "\t" in indent:
        tab = say("this line is indented with a tab: use spaces, not tabs")
        raise YamlError(mark.line + 1, indent.index("\t") + 1, tab) from error
    fault = fault_of(error, text)
    words = say(fault.words) if fault.words else say("not YAML: {reason}", reason=error.problem)
    raise YamlError(fault.line, fault.column, words) from error


def tell_character(text: str, offset: int) -> NoReturn:
    """Raise a YamlError for a character that YAML does not allow."""
    before = text[:offset]
    line = before.count("\n") + 1
    column = offset - (before.rfind("\n") + 1) + 1
    code = f"{ord(text[offset]):04X}"
    raise YamlError(line, column, say("the character U+{code} is not allowed", code=code))


def _tell_unprintable(error: yaml.YAMLError, text: str) -> NoReturn:
    for offset, character in enumerate(text):
        if yaml.reader.Reader.NON_PRINTABLE.match(character):
            tell_character(text, offset)
    raise YamlError(1, 1, say("not YAML: {reason}", reason=str(error))) from error

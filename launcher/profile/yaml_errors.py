"""What PyYAML refuses, told in words that help whoever wrote the file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import yaml

from launcher.profile.tree import Place
from text.sentences import say
from text.yaml_faults import fault_of

if TYPE_CHECKING:
    from launcher.profile.tree import Problems


def tell_syntax(error: yaml.YAMLError, text: str, file: str, problems: Problems) -> None:
    """Tell a syntax error in words that help whoever wrote the file."""
    if not isinstance(error, yaml.MarkedYAMLError) or error.problem_mark is None:
        _character_problem(error, text, file, problems)
        return
    mark = error.problem_mark
    lines = text.splitlines()
    content = lines[mark.line] if mark.line < len(lines) else ""
    indent = content[: len(content) - len(content.lstrip())]
    if "\t" in indent:
        place = Place(file, mark.line + 1, indent.index("\t") + 1)
        problems.add(
            place, (), say("this line is indented with a tab"), say("use spaces, not tabs")
        )
        return
    fault = fault_of(error, text)
    found = ", ".join(words for words in (error.problem, error.context) if words)
    reason = say(fault.words) if fault.words else found
    message = say("not YAML: {reason}", reason=reason)
    problems.add(Place(file, fault.line, fault.column), (), message)


def _character_problem(error: yaml.YAMLError, text: str, file: str, problems: Problems) -> None:
    """A character that YAML does not allow at all: PyYAML's reader tells its offset only."""
    for offset, character in enumerate(text):
        if yaml.reader.Reader.NON_PRINTABLE.match(character):
            before = text[:offset]
            line = before.count("\n") + 1
            column = offset - (before.rfind("\n") + 1) + 1
            message = say("the character U+{code:04X} is not allowed", code=ord(character))
            problems.add(Place(file, line, column), (), message, say("remove it"))
            return
    problems.add(Place(file), (), say("not YAML: {reason}", reason=str(error)))

"""Reads the YAML of a profile, or of a single value for it; errors are collected as problems."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from launcher.profile.text import MAX_BYTES
from text.sentences import say
from text.yaml_faults import YamlError
from text.yaml_tree import FilePlace, Rules, Scalar, check_colons, empty, mapping, read

if TYPE_CHECKING:
    from launcher.profile.problems import Problems
    from text.yaml_tree import Branch, Tree

RULES = Rules(shares=True, longest=MAX_BYTES, deepest=24, most=20_000)


def read_yaml(text: str, file: str, problems: Problems) -> Branch | None:
    """Return the only document of `text`, a mapping, or None and problems that say why not."""
    try:
        root = read(text, RULES, file, partial(problems.take, file))
        if root is not None and not empty(root):
            check_colons(root)
            return mapping(root)
    except YamlError as error:
        problems.take(file, error)
        return None
    hint = say("a profile has at least `nodes:`")
    problems.add(FilePlace(file, 1, 1), (), say("is empty"), hint)
    return None


def read_value(text: str, file: str, problems: Problems) -> Tree | None:
    """Return the value that a piece of YAML stands for, as of `--set`; None and a problem else."""
    try:
        root = read(text, RULES, file, partial(problems.take, file))
    except YamlError as error:
        problems.take(file, error)
        return None
    return root or Scalar("", "", FilePlace(file))

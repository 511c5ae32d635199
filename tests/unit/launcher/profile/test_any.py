"""Whatever stands in a file, it is a profile or it is told what is wrong: never a crash."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from launcher.errors import ProfileError
from launcher.profile.load import load_profile
from launcher.profile.model import NodeDocument, ProfileDocument, ReadyDocument

KEYS = sorted(
    {
        *(*ProfileDocument.model_fields, *NodeDocument.model_fields, *ReadyDocument.model_fields),
        *("a", "b", "en", "pico", "port", "<<", "x y", "", "1"),
    }
)
WORDS = st.sampled_from(
    [*KEYS, "nodes.hello", "localhost", "sonar", "${devices.pico.port}", 'hardware == "mock"', "/x"]
)
SCALARS = st.one_of(
    WORDS, st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8)
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.one_of(
        st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(KEYS), inner, max_size=4)
    ),
    max_leaves=12,
)
NODE = st.dictionaries(st.sampled_from(sorted(NodeDocument.model_fields)), ANYTHING, max_size=6)
PROFILE = st.fixed_dictionaries(
    {"nodes": st.dictionaries(st.sampled_from(["a", "b", "c"]), NODE, max_size=3)},
    optional={name: ANYTHING for name in ProfileDocument.model_fields if name != "nodes"},
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("profiles")


def load(path: Path) -> None:
    """Load a profile, or be told what is wrong with it, and where."""
    try:
        load_profile(path, environ={"DECK_PICO_PORT": "x"}, overrides=("a.rate=1",))
    except ProfileError as error:
        for problem in error.problems:
            assert problem.message
            assert problem.line > 0 or problem.file.startswith("--set")


@given(data=st.one_of(PROFILE, ANYTHING))
def test_any_yaml(data: Any, folder: Path) -> None:
    path = folder / "any.yaml"
    path.write_text(yaml.safe_dump(data, allow_unicode=True, sort_keys=False), encoding="utf-8")
    load(path)


@given(data=st.binary(max_size=200))
def test_any_bytes(data: bytes, folder: Path) -> None:
    path = folder / "bytes.yaml"
    path.write_bytes(b"nodes: " + data)
    load(path)

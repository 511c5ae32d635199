"""A field of a node is declared in the model alone: reading, joining and the schema follow."""

import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import launcher.profile.model
from launcher.profile.model import NodeDocument
from launcher.profile.spec import NodeSpec

BEFORE = "    restart: Restart = Field("
TRIAL = """    stars: Annotated[dict[str, str], AsText(), Joined()] = Field({}, description="?")
"""
USED = """
import importlib.util, sys
spec = importlib.util.spec_from_file_location("launcher.profile.model", sys.argv[1])
sys.modules[spec.name] = model = importlib.util.module_from_spec(spec)
spec.loader.exec_module(model)

from launcher.profile.load import ProfileError, load_profile
from launcher.profile.schema import render

print(load_profile(sys.argv[2]).nodes["a"].document.stars)
try:
    load_profile(sys.argv[3])
except ProfileError as error:
    print(error.problems[0].hint)
print('"stars"' in render())
"""


def test_what_a_node_comes_to_repeats_no_field_that_stays_as_it_is_written() -> None:
    repeated = {field.name for field in fields(NodeSpec)} & set(NodeDocument.model_fields)
    assert repeated == {"params", "needs", "ready", "cwd"}


def test_a_new_field_is_one_line_in_the_model(tmp_path: Path) -> None:
    source = Path(launcher.profile.model.__file__).read_text()
    assert source.count(BEFORE) == 1
    model = tmp_path / "model.py"
    model.write_text(source.replace(BEFORE, TRIAL + BEFORE))
    base, own, wrong = (tmp_path / f"{name}.yaml" for name in ("base", "own", "wrong"))
    base.write_text("nodes: {a: {run: nodes.hello, stars: {x: 1, y: 0.10}}}")
    own.write_text("extends: base\nnodes: {a: {stars: {x: 2}}}")
    wrong.write_text("nodes: {a: {run: nodes.hello, star: {}}}")
    done = subprocess.run(
        [sys.executable, "-c", USED, str(model), str(own), str(wrong)],
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout.splitlines() == [
        "{'x': '2', 'y': '0.10'}",
        "did you mean stars?",
        "True",
    ]

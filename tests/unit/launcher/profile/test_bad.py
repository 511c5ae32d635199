"""Everything that can be wrong with a profile: the place, the field and the mend are told."""

from __future__ import annotations

import os
from dataclasses import fields
from pathlib import Path
from typing import Any

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from launcher.errors import ProfileError
from launcher.parts import Given, marked
from launcher.profile.load import load_profile
from launcher.profile.model import Profile
from launcher.profile.node import Node, Ready
from launcher.profile.panels import PANELS
from tests.unit.profile_files import refused, told, written

BAD = [
    ("nodes: {a: {run: ./mien.py}}", "1:18: nodes.a.run: there is no file "),
    ("lession: 1\nnodes: {a: {exec: [x]}}", "1:1: lession: unknown key (did you mean lesson?)"),
    ("nodes:\n  a:\n    exec: [x]\n    parms: {}",
     "4:5: nodes.a.parms: unknown key (did you mean params?)"),
    ("nodes: {a: {exec: [x], ready: {zzz: 1, node: b}}}",
     "1:32: nodes.a.ready.zzz: unknown key (known: topic, type, rate, service, node, lifecycle, within)"),
    ("nodes: {a: {run: 12}}", "1:18: nodes.a.run: expected text, found 12 (put it in quotes)"),
    ("domain: many\nnodes: {a: {exec: [x]}}",
     "1:9: domain: expected a whole number, found the text 'many'"),
    ("nodes:\n  a:\n    exec: [x]\n    ready:\n      node: a\n      within: 2,5",
     "6:15: nodes.a.ready.within: expected a number, found the text '2,5' (write a fraction with a point: 2.5)"),
    ("nodes:\n  a: {exec: [x]}\n  b: {exec: [x], needs: a}",
     "3:25: nodes.b.needs: expected a list, found the text 'a' (write [a])"),
    ("nodes: {a: {exec: ros2 run pkg exe}}",
     "1:19: nodes.a.exec: expected a list, found a single text; write [ros2, run, pkg, exe]"),
    ("nodes: {a: {exec: []}}",
     "1:19: nodes.a.exec: an empty command; write for example [ros2, run, package, program]"),
    ("nodes: [a]", "1:8: nodes: expected keys and values, found a list"),
    ("nodes: {a: sleep}", "1:12: nodes.a: expected keys and values, found the text 'sleep'"),
    ("nodes: {a: {exec: [x], restart: allways}}",
     "1:33: nodes.a.restart: expected one of never, on-failure, always, found the text 'allways' (did you mean always?)"),
    ("panels: [sonr]\nnodes: {a: {exec: [x]}}",
     f"1:10: panels[0]: expected one of {', '.join(PANELS)}, found the text 'sonr' (did you mean sonar?)"),
    ("nodes: {a: {exec: [x], ready: {node: a, within: 0}}}",
     "1:49: nodes.a.ready.within: expected more than 0, found 0"),
    ("domain: 233\nnodes: {a: {exec: [x]}}", "1:9: domain: expected at most 232, found 233"),
    ("domain: -1\nnodes: {a: {exec: [x]}}", "1:9: domain: expected at least 0, found -1"),
    ("discovery: lan\nnodes: {a: {exec: [x]}}",
     "1:12: discovery: expected localhost, subnet or a list of addresses, found 'lan'"),
    ("discovery: [robot;rm]\nnodes: {a: {exec: [x]}}",
     "1:12: discovery: 'robot;rm' is not an address; write it as 192.168.1.7 or robot.local"),
    ("nodes:\n  sonar: {exec: [x]}\n  b: {exec: [x], needs: [sonr]}",
     "3:26: nodes.b.needs[0]: there is no node 'sonr' (did you mean sonar?)"),
    ("nodes:\n  a: {exec: [x], needs: [b]}\n  b: {exec: [x], needs: [c]}\n  c: {exec: [x], needs: [a]}",
     "2:25: nodes.a.needs: nodes need each other in a cycle: a -> b -> c -> a (remove one of the needs)"),
    ("nodes: {a: {exec: [x], needs: [a]}}",
     "1:31: nodes.a.needs: nodes need each other in a cycle: a -> a (remove one of the needs)"),
    ("nodes:\n  a: {exec: [x], optional: true}\n  b: {exec: [x], needs: [a]}",
     "3:26: nodes.b.needs[0]: a is optional, so nothing can need it"),
    ("nodes: {a: {run: nodes.helo}}",
     "1:18: nodes.a.run: there is no module 'nodes.helo' (did you mean nodes.hello?)"),
    ("nodes: {a: {run: hello}}",
     "1:18: nodes.a.run: there is no module 'hello' (did you mean nodes.hello?)"),
    ("nodes: {a: {run: mine.py}}",
     "1:18: nodes.a.run: there is no module 'mine.py' (for your own file write run: ./mine.py)"),
    ("nodes: {a: {run: nodes}}", "1:18: nodes.a.run: there is no module 'nodes'"),
    ("nodes: {a: {run: nodes/hello.py}}",
     "1:18: nodes.a.run: 'nodes/hello.py' is not a Python module; write a module as nodes.hello, a file of your own as ./my_node.py"),
    ("nodes:\n  a:\n    run: nodes.hello\n    exec: [x]",
     "4:5: nodes.a: has both `run` and `exec` (keep one)"),
    ("nodes:\n  a: {params: {x: 1}}",
     "2:3: nodes.a: needs `run` or `exec` (write run: nodes.hello)"),
    ("nodes:\n  a:\n", "2:3: nodes.a: needs `run` or `exec` (write run: nodes.hello)"),
    ("nodes: {front-sonar: {exec: [x]}}",
     "1:9: nodes.front-sonar: 'front-sonar' is not a valid name for a ROS node (letters, digits and _, not beginning with a digit)"),
    ("nodes:\n  a: {exec: [x]}\n  b: {exec: [x]}\n  a: {exec: [y]}",
     "4:3: nodes.a: 'a' appears a second time, first on line 2: join them or rename one"),
    ("lesson: 1\nlesson: 2\nnodes: {a: {exec: [x]}}",
     "2:1: lesson: 'lesson' appears a second time, first on line 1: join them or rename one"),
    ("nodes:\n\ta: {exec: [x]}", "2:1: this line is indented with a tab: use spaces, not tabs"),
    ("", "1:1: is empty (a profile has at least `nodes:`)"),
    ("# nothing\n", "1:1: is empty (a profile has at least `nodes:`)"),
    ("- a\n- b", "1:1: expected `name: value`, found a list"),
    ("hello", "1:1: expected `name: value`, found a single value"),
    ("nodes: {a: {exec: [x]}}\n---\nnodes: {}",
     "2:1: a second document begins here, and only one is read"),
    ("lesson: 1", "1:1: nodes: there are no nodes to start"),
    ("nodes: !!python/object/apply:os.system [ls]",
     "1:8: the tag !!python/object/apply:os.system is refused: only plain values are read"),
    ("nodes: {a: {exec: [x], when: hardware = mock}}",
     "1:30: nodes.a.when: 'hardware = mock' is not a condition (write for example: hardware == \"mock\")"),
    ("nodes: {a: {exec: [x], when: 'hardwar == \"mock\"'}}",
     "1:30: nodes.a.when: 'hardwar' is not known (did you mean hardware?)"),
    ("nodes: {a: {exec: [x], when: 'hardware == \"rael\"'}}",
     "1:30: nodes.a.when: hardware is never 'rael', only one of mock, real (did you mean real?)"),
    ("nodes: {a: {exec: [x], params: {rate: }}}",
     "nodes.a.params.rate: a ROS parameter cannot be empty (give it a value, or leave it out)"),
    ("nodes: {a: {exec: [x], params: {l: [1, x]}}}",
     "1:36: nodes.a.params.l: a list in ROS holds one type, this one holds integer, string (quote all of them, or none)"),
    ("nodes: {a: {exec: [x], params: {l: []}}}",
     "1:36: nodes.a.params.l: an empty list has no type in ROS (leave the parameter out)"),
    ("nodes: {a: {exec: [x], params: {l: [[1]]}}}",
     "1:37: nodes.a.params.l[0]: ROS has no parameter that is a list of lists (give each its own name)"),
    ("nodes: {a: {exec: [x], params: {n: 9223372036854775808}}}",
     "1:36: nodes.a.params.n: 9223372036854775808 does not fit into 64 bits"),
    ("nodes: {a: {exec: [x], params: {max-speed: 1}}}",
     "1:33: nodes.a.params.max-speed: 'max-speed' is not a valid name for a ROS parameter (letters, digits and _, joined by dots)"),
    ("nodes: {a: {exec: [x], remap: {/drive: drive safe}}}",
     "1:40: nodes.a.remap./drive: 'drive safe' is not a ROS name; write it as /sensor/sonar_front"),
    ("nodes: {a: {exec: [x], ready: {node: a, topic: b}}}",
     "1:31: nodes.a.ready: expected exactly one of topic, service, node, lifecycle (write ready: {topic: /chatter, within: 10})"),
    ("nodes: {a: {exec: [x], ready: {lifecycle: active, topic: b}}}",
     "1:31: nodes.a.ready: expected exactly one of topic, service, node, lifecycle (write"),
    ("nodes: {a: {exec: [x], lifecycle: active, ready: {topic: b, service: c}}}",
     "1:50: nodes.a.ready: expected exactly one of topic, service, node, lifecycle (write"),
    ("nodes: {a: {exec: [x], ready: {lifecycle: activ}}}", "1:43: nodes.a.ready.lifecycle: "),
    ("nodes: {a: {exec: [x], lifecycle: finalized}}", "1:35: nodes.a.lifecycle: "),
    ("nodes: {a: {exec: [x], lifecycle: {state: active}}}", "1:35: nodes.a.lifecycle: "),
    ("nodes: {a: {exec: [x], ready: {topic: b, type: Float32}}}",
     "1:48: nodes.a.ready.type: 'Float32' is not a message type; write it as std_msgs/msg/Float32"),
    ("nodes: {a: {exec: [x], ready: {service: b, rate: 5}}}",
     "1:44: nodes.a.ready.rate: `rate` belongs to a topic, but none is given here (write ready: {topic: /chatter, type: std_msgs/msg/String, rate: 1})"),
    ("nodes: {a: {exec: [x], cwd: nowhere}}", "1:29: nodes.a.cwd: there is no directory"),
    ("extends: 09-brian\nnodes: {a: {exec: [x]}}",
     "1:10: extends: there is no profile '09-brian' to extend (did you mean 09-brain?)"),
    ("extends: /\nnodes: {a: {exec: [x]}}", "1:10: extends: there is no profile '/' to extend"),
    ("extends: ..\nnodes: {a: {exec: [x]}}", "1:10: extends: there is no profile '..' to extend"),
    ("extends: ''\nnodes: {a: {exec: [x]}}", "1:10: extends: there is no profile '' to extend"),
    ("extends: lesson\nnodes: {a: {exec: [x]}}",
     "1:10: extends: profiles extend each other in a cycle: lesson -> lesson"),
    ("devices: {pico: {port: /dev/a}}\nnodes: {a: {exec: [x, '${devices.pico.prt}']}}",
     "2:23: nodes.a.exec[1]: there is no device setting 'pico.prt' (did you mean pico.port?)"),
    ("devices: {pico: {port: [a, b]}}\nnodes: {a: {exec: [x]}}", "expected a single value"),
]  # fmt: skip


@pytest.mark.parametrize(("above", "model"), [("{key}: 1", Profile), ("nodes: {{a: {{exec: [x], {key}: 1}}}}", Node)])
def test_what_the_loader_gives_cannot_be_written(above: str, model: type, tmp_path: Path) -> None:
    for key in marked(model, Given):
        text = above.format(key=key) if model is Node else above.format(key=key) + "\nnodes: {a: {exec: [x]}}"
        (message,) = told(tmp_path, text)
        assert f"{key}: unknown key" in message


@pytest.mark.parametrize(("text", "expected"), BAD)
def test_one_message_tells_place_field_and_mend(text: str, expected: str, tmp_path: Path) -> None:
    (tmp_path / "mine.py").touch()
    messages = told(tmp_path, text)
    assert len(messages) == 1
    assert expected in messages[0]


def test_a_profile_is_not_offered_to_extend_itself(tmp_path: Path) -> None:
    messages = told(tmp_path, "extends: lesso\nnodes: {a: {exec: [x]}}")
    assert messages == ["1:10: extends: there is no profile 'lesso' to extend"]


def test_all_that_is_wrong_is_told_at_once_in_order_of_lines(tmp_path: Path) -> None:
    messages = told(
        tmp_path,
        """\
        domain: 300
        nodes:
          a: {exec: [x], needs: [b], params: {x: []}}
          b: {run: nodes.helo, restart: maybe}
        """,
        overrides=("c.x=1",),
    )
    lines = [message.split(":", 2)[:2] for message in messages[1:]]
    assert messages[0].startswith("--set c.x=1: there is no node 'c'")
    assert lines == [["1", "9"], ["3", "42"], ["4", "12"], ["4", "33"]]


def test_a_yaml_bomb_is_refused_before_it_grows(tmp_path: Path) -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 9)}]" for n in range(1, 12)]
    messages = told(tmp_path, "\n".join(lines))
    assert len(messages) == 1
    assert "more than 20000 values, counting aliases" in messages[0]


def test_endless_nesting_is_refused(tmp_path: Path) -> None:
    messages = told(tmp_path, "nodes: " + "[" * 100_000)
    assert len(messages) == 1
    assert "nested too deeply" in messages[0]


def test_a_circle_of_profiles_is_named(tmp_path: Path) -> None:
    written(tmp_path, "extends: b\nnodes: {x: {exec: [x]}}", "a.yaml")
    written(tmp_path, "extends: c", "b.yaml")
    written(tmp_path, "extends: a", "c.yaml")
    assert "profiles extend each other in a cycle: a -> b -> c -> a" in refused(tmp_path / "a.yaml")


def test_a_chain_of_profiles_without_end_is_refused(tmp_path: Path) -> None:
    for number in range(1500):
        written(tmp_path, f"extends: p{number + 1}", f"p{number}.yaml")
    written(tmp_path, "nodes: {x: {exec: [x]}}", "p1500.yaml")
    assert "p31.yaml:1:10: extends: more than 32 profiles extend each other" in refused(tmp_path / "p0.yaml")
    assert list(load_profile(tmp_path / "p1469.yaml").nodes) == ["x"]


def test_a_fault_in_an_extended_profile_names_that_file(tmp_path: Path) -> None:
    base = written(tmp_path, "nodes:\n  x: {exec: [x], warm: 1}", "base.yaml")
    own = written(tmp_path, "extends: base\nlesson: 2", "own.yaml")
    assert f"{base}:2:24: nodes.x.warm: expected true or false" in refused(own)


def test_a_missing_file_is_told(tmp_path: Path) -> None:
    assert "none.yaml: no such file" in refused(tmp_path / "none.yaml")


def test_a_directory_is_told_with_the_profiles_in_it(tmp_path: Path) -> None:
    written(tmp_path, "nodes: {}", "a.yaml")
    assert "found a directory (it contains: a.yaml)" in refused(tmp_path)


def test_a_pipe_is_not_waited_for(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.yaml")
    assert "not a regular file" in refused(tmp_path / "pipe.yaml")


def test_a_file_without_permission_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written(tmp_path, "nodes: {}")

    def forbidden(*_args: object, **_options: object) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", forbidden)
    assert "no permission to read it" in refused(path)


def test_bytes_that_are_not_utf8_are_told_with_their_place(tmp_path: Path) -> None:
    path = tmp_path / "latin.yaml"
    path.write_bytes("nodes: {}\ntitle: Урок".encode("cp1251"))
    assert "latin.yaml:2:8: is not UTF-8: byte 0xd3 (save the file as UTF-8)" in refused(path)


def test_a_huge_file_is_told(tmp_path: Path) -> None:
    path = tmp_path / "huge.yaml"
    path.write_text("#" * 300_000)
    assert "is larger than 256 KiB" in refused(path)


NODE_KEYS = sorted(field.name for field in fields(Node))
KEYS = sorted(
    {
        *(*Profile.model_fields, *NODE_KEYS, *(field.name for field in fields(Ready))),
        *("a", "b", "en", "pico", "port", "<<", "x y", "", "1"),
    }
)
WORDS = st.sampled_from(
    [*KEYS, "nodes.hello", "localhost", "sonar", "${devices.pico.port}", 'hardware == "mock"', "/x"]
)
SCALARS = st.one_of(WORDS, st.none(), st.booleans(), st.integers(), st.floats(), st.text(max_size=8))
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(st.sampled_from(KEYS), inner, max_size=4)),
    max_leaves=12,
)
NODE = st.dictionaries(st.sampled_from(NODE_KEYS), ANYTHING, max_size=6)
PROFILE = st.fixed_dictionaries(
    {"nodes": st.dictionaries(st.sampled_from(["a", "b", "c"]), NODE, max_size=3)},
    optional={name: ANYTHING for name in Profile.model_fields if name != "nodes"},
)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("profiles")


def load(path: Path) -> None:
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

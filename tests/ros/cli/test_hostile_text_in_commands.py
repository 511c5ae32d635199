"""Whatever a profile, a node, a path or the environment holds: no command writes it as it is."""

from __future__ import annotations

import contextlib
import json
import os
import pty
import signal
import subprocess
import sys
import threading
from collections.abc import AsyncIterator, Callable
from pathlib import Path

import pytest

from launcher.client.client import running
from tests.forked_deck import forked_deck
from tests.hostile_text import EVIL, EVIL_NAME, WORST, harm_in, quoted
from tests.middleware_words import own_words
from tests.ros.supervised import end_sessions
from tests.unit.bags import write_bag
from tests.waiting import wait_until

pytestmark = pytest.mark.nightly

Said = Callable[..., bytes]


@pytest.fixture(autouse=True)
async def _domain(ros_domain: int) -> AsyncIterator[int]:
    yield ros_domain
    await end_sessions()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a name that nobody should have to read."""
    made = tmp_path / EVIL_NAME
    made.mkdir()
    return made


PRINTING = f"""\
import sys, time
evil = {EVIL!r}.encode()
sys.stdout.buffer.write(evil + b"\\xff\\0\\n[ERROR] [1.0] [" + evil + b"]: x\\n")
sys.stdout.flush()
time.sleep(100)
"""


def good(folder: Path) -> Path:
    """Write a profile that can be started, evil wherever that is allowed."""
    path = folder / f"{EVIL_NAME}.yaml"
    script = folder / "talks.py"
    script.write_text(PRINTING, encoding="utf-8")
    evil, worst = quoted(EVIL), quoted(WORST)
    path.write_text(
        f"""\
title: {{en: {worst}, ru: {worst}}}
about: {{en: {worst}}}
nodes:
  talks: {{exec: [{quoted(sys.executable)}, {quoted(str(script))}], env: {{EVIL: {evil}}}}}
  missing: {{exec: [{evil}, {evil}], restart: never}}
  gone: {{exec: ["sh", "-c", "echo $0 >&2; exit 3", {evil}], restart: never}}
""",
        encoding="utf-8",
    )
    return path


BAD = """\
title: {WORST}
{WORST}: 1
devices: {{{WORST}: {{port: {WORST}, kind: {WORST}}}}}
domain: {WORST}
discovery: {WORST}
panels: [{WORST}]
extends: {WORST}
nodes:
  {WORST}: {{run: nodes.hello}}
  a: {{run: {WORST}}}
  b: {{exec: {WORST}, remap: {{{WORST}: {WORST}}}, needs: [{WORST}], restart: {WORST}}}
  c: {{run: nodes.hello, when: {WORST}, params: {{{WORST}: {WORST}}}, {WORST}: 1}}
  d: {{exec: [x], env: {{{WORST}: {WORST}}}, ready: {{topic: {WORST}, within: {WORST}}}}}
"""


def bad(folder: Path, text: str = BAD) -> Path:
    """Write a profile in which everything is wrong."""
    path = folder / f"{EVIL_NAME}-bad.yaml"
    path.write_text(text.format(WORST=quoted(WORST)), encoding="utf-8")
    return path


@pytest.fixture
def said(tmp_path: Path) -> Said:
    """Return all that a command writes, both streams, having seen that there is something."""

    def said(*arguments: str, **env: str) -> bytes:
        out, err = tmp_path / "out.txt", tmp_path / "err.txt"
        for each in (out, err):
            each.write_bytes(b"")
        forked_deck(*arguments, out=out, err=err, env=env)
        return both(out.read_bytes(), err.read_bytes())

    return said


def both(output: bytes, errors: bytes) -> bytes:
    """Return the two together; they are not empty, and no traceback."""
    assert b"Traceback" not in errors, errors.decode(errors="replace")
    assert output + errors
    return output + own_words(errors.decode(errors="surrogateescape")).encode(
        errors="surrogateescape"
    )


def started(*arguments: str, **env: str) -> bytes:
    """Return all that a command writes, started in another environment."""
    done = subprocess.run(
        [sys.executable, "-m", "tui", *arguments],
        stdin=subprocess.DEVNULL,
        capture_output=True,
        env={**os.environ, **env},
        timeout=60,
        check=False,
    )
    return both(done.stdout, done.stderr)


def shown(*arguments: str) -> bytes:
    """Return all that a command writes to a terminal, its colours included."""
    master, slave = pty.openpty()
    output = b""

    def read() -> None:
        nonlocal output
        with contextlib.suppress(OSError):  # The other end is closed.
            while data := os.read(master, 65536):
                output += data

    terminal = Path(os.ttyname(slave))
    reader = threading.Thread(target=read, daemon=True)
    reader.start()
    forked_deck(*arguments, out=terminal, err=terminal, env={"TERM": "xterm-256color"})
    os.close(slave)
    reader.join(60)
    os.close(master)
    assert output
    return output


@pytest.mark.parametrize("lang", ["en", "ru"])
def test_what_is_wrong_in_a_profile_is_told_harmlessly(said: Said, folder: Path, lang: str) -> None:
    path = str(bad(folder))
    for command in ("check", "run", "up"):
        output = said(command, path, "--lang", lang)
        assert b"evil" in output
        assert not harm_in(output), command
    assert not harm_in(shown("check", path, "--lang", lang), coloured=True)


@pytest.mark.parametrize(
    "text",
    ["nodes: {{a: [", "{WORST}", "a: 1\na: 2\n{WORST}: 1\n{WORST}: 2", "a: *x", "\t{WORST}: !!x 1"],
)
def test_what_is_no_yaml_is_told_harmlessly(said: Said, folder: Path, text: str) -> None:
    assert not harm_in(said("check", str(bad(folder, text))))


def test_raw_bytes_in_a_profile_are_told_harmlessly(said: Said, folder: Path) -> None:
    path = folder / "raw.yaml"
    for evil in (b"nodes: {\x1b]52;c;x\x07: 1}", "nodes: {\u202ea: 1}".encode(), b"\xff\x9b"):
        path.write_bytes(evil)
        assert not harm_in(said("check", str(path)))


def test_words_on_the_command_line_are_repeated_harmlessly(said: Said, folder: Path) -> None:
    nowhere = str(folder / "nowhere.yaml")
    for words in (
        (EVIL,),
        ("run", EVIL),
        ("run", nowhere),
        ("check", str(folder)),
        ("run", "01-hello", "--for", EVIL),
        ("run", "01-hello", "--domain", EVIL),
        ("run", "01-hello", "--hardware", EVIL),
        ("check", "01-hello", "--set", f"{EVIL}.a=1"),
        ("check", "01-hello", "--set", f"hello.{EVIL}={EVIL}"),
        ("check", "01-hello", "--set", EVIL),
        ("list", f"--{EVIL}"),
        ("list", "--lang", EVIL),
        ("logs", EVIL),
        ("logs", "--profile", EVIL),
        ("attach", EVIL),
        ("down", EVIL),
        ("record", EVIL),
        ("record", "-o", EVIL, "--for", EVIL),
        ("replay", EVIL),
        ("replay", "x", "--rate", EVIL),
    ):
        output = said(*words)
        assert not harm_in(output), (words, output)


@pytest.mark.parametrize("command", ["list", "doctor", "ps"])
@pytest.mark.parametrize(
    "name",
    [
        *("ROS_DOMAIN_ID", "RMW_IMPLEMENTATION", "DECK_PICO_PORT", "DECK_PICO_BAUD", "LANG"),
        *("DECK_RUN_DIR", "DECK_LOG_DIR", "ROS_DISTRO", "ROS_STATIC_PEERS", "TERM", "USER"),
    ],
)
def test_the_environment_is_told_harmlessly(command: str, name: str, tmp_path: Path) -> None:
    value = str(tmp_path / EVIL_NAME) if name.endswith("_DIR") else EVIL
    assert not harm_in(started(command, **{name: value}))


def test_devices_and_domains_of_the_environment_are_told_harmlessly(said: Said) -> None:
    for env in (
        {"ROS_DOMAIN_ID": EVIL},
        {"DECK_PICO_PORT": EVIL, "DECK_CAMERA_PORT": EVIL, "DECK_SERVO_PORT": EVIL},
        {"DECK_PICO_BAUD": EVIL},
        {"DECK_LOG_DIR": "/proc/" + EVIL},
        {"DECK_RUN_DIR": "/proc/" + EVIL},
    ):
        preflight = said("check", "robot", "--hardware", "real", "--preflight", **env)
        assert not harm_in(preflight), env
        assert not harm_in(said("check", "robot", "--hardware", "real", **env)), env
        assert not harm_in(said("up", "nowhere", **env)), env


def test_a_lesson_that_runs_says_all_harmlessly(said: Said, folder: Path) -> None:
    path = str(good(folder))
    assert not harm_in(said("check", path))
    run = said("run", path, "--for", "1")
    assert b"]52;c;ZXZpbA==" in run
    assert not harm_in(run)
    assert not harm_in(shown("run", path, "--for", "1"), coloured=True)


def test_what_runs_in_the_background_is_told_harmlessly(
    said: Said, folder: Path, tmp_path: Path
) -> None:
    path = str(good(folder))
    assert not harm_in(said("up", path))
    assert not harm_in(said("up", path))
    for command in (("ps",), ("logs", "-n", "100"), ("logs", "talks"), ("logs", EVIL)):
        assert not harm_in(said(*command)), command
        assert not harm_in(shown(*command), coloured=True), command
    talk = said("logs", "talks")
    assert "␛]52;c;ZXZpbA==␇".encode() in talk
    assert "evil" in str(list((tmp_path / "logs").iterdir()))
    assert not harm_in(said("down"))


def test_json_says_the_same_text_with_escapes(said: Said, folder: Path) -> None:
    listed = said("check", "--json", str(bad(folder)))
    assert not harm_in(listed)
    assert "\u202e" in json.loads(listed)[0]["path"]
    path = str(good(folder))
    run = said("run", path, "--for", "1", "--json")
    assert not harm_in(run)
    session, *_events = map(json.loads, run.decode().splitlines())
    assert session["title"]["en"] == WORST
    assert session["profile"].endswith(f"{EVIL_NAME}.yaml")
    said("up", path)
    assert not harm_in(said("ps", "--json"))


def test_folders_and_topics_of_recordings_are_told_harmlessly(said: Said, folder: Path) -> None:
    walk = folder / "walk"
    assert not harm_in(said("record", "-o", str(walk), "--for", "0.2"))
    bag = write_bag(folder / "bag", 1.0)
    metadata = bag / "metadata.yaml"
    evil = metadata.read_text(encoding="utf-8").replace("/number", EVIL.replace("\n", ""))
    metadata.write_text(evil, encoding="utf-8")
    for name in (bag, folder, folder / "nowhere"):
        assert not harm_in(said("replay", str(name)))


def test_a_fault_of_its_own_is_told_harmlessly() -> None:
    program = (
        "from text.output import make_streams_safe; make_streams_safe();"
        f"raise RuntimeError({WORST!r} + chr(0xD800))"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, check=False)
    assert b"RuntimeError" in done.stderr
    assert not harm_in(done.stderr)


def test_log_files_hold_what_the_supervisor_says_harmlessly(
    said: Said, folder: Path, tmp_path: Path
) -> None:
    said("up", str(good(folder)))
    files = wait_until(
        lambda: [*(tmp_path / "logs").rglob("missing.log")], "the log of what could not start"
    )
    assert not harm_in(wait_until(files[0].read_bytes, "its text"))
    os.kill(next(iter(running())).supervisor_pid, signal.SIGTERM)

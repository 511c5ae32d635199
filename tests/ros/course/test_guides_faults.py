"""Nodes with the imports, the idioms and the faults of the guide: they run, faults are explained.

`tests/course` has them as the guide writes them, but for one line of `ai_brain`, which cannot work.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from launcher.status import NodeState, Severity
from tests.middleware_words import own_words
from tests.ros.supervised import Launch, said, until_state
from tests.waiting import until

COURSE = Path(__file__).parents[2] / "course"
FILES = sorted(file.name for file in COURSE.glob("[a-z]*.py"))
END = "rclpy has been shut down already: write rclpy.try_shutdown(), not rclpy.shutdown()."
BYTES = 'message.data is a list of single bytes: b"".join(message.data) puts them together.'
TALK = """\
import rclpy
from std_msgs.msg import ByteMultiArray
rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(ByteMultiArray, "/audio/mic_raw", 10)
node.create_timer(0.2, lambda: publisher.publish(ByteMultiArray(data=b"look around")))
rclpy.spin(node)
"""
CTRL_C = "Ctrl-C is the exception"
# With job control, as in a terminal. Without it they would begin with SIGINT ignored, and of that
# alone rclpy may wake before it has noted that it is the end.
IN_THE_SHELL = """\
set -m
for file in *.py; do python3 $file 2>$file.log & eval pid_${file%.py}=$!; done
for file in *.py; do
    until grep -q started $file.log; do sleep 0.1; done
    eval pid=\\$pid_${file%.py}
    kill -INT $pid; wait $pid; echo $file $?
done
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """The guide's files, each a node, beside a profile."""
    for file in FILES:
        shutil.copy(COURSE / file, tmp_path)
    brain = (tmp_path / "ai_brain.py").read_text()
    assert 'b"".join(' in brain
    (tmp_path / "ai_brain.py").write_text(brain.replace('b"".join(', "bytes("))
    return tmp_path


async def test_the_guides_files_run_and_their_faults_are_explained(start: Launch, folder: Path) -> None:
    (folder / "talk.py").write_text(TALK)
    client = await start(
        {
            **{file[:-3]: {"run": f"./{file}"} for file in FILES},
            # The same by the other way, with a Python that starts anew.
            "talker": {"exec": ["python3", "talk.py"], "ready": {"topic": "/audio/mic_raw"}},
        }
    )
    assert await said(client, "vlm_agent_stub", "a picture of ") == "640x480"
    fault = await until(lambda: client.nodes["ai_brain"].fault, "the fault is told", 60)
    assert fault is not None
    assert (fault.meaning, "bytes(message.data)" in fault.source_line) == (BYTES, True)
    await client.stop()
    ends = []
    for name in client.nodes.keys() - {"ai_brain", "talker"}:
        status = await until_state(client, name, NodeState.EXITED)
        ends.append((name, str(status.fault), status.detail))
        # Of eleven that end at once one may hang in the middleware: it is killed in silence. One
        # that a busy machine has not brought as far as rclpy.spin ends by Ctrl-C itself.
        wanted = next((words for words in (END, CTRL_C) if words in str(status.fault)), "")
        assert wanted or "SIGKILL" in status.detail, ends[-1]
        told = [line for line in await client.history(name, 100) if wanted in line.text]
        assert not wanted or [line.severity for line in told] == [Severity.WARN], name
    assert CTRL_C in {name: fault for name, fault, _ in ends}["hello"]
    assert sum(END in fault for _, fault, _ in ends) > len(ends) / 2, ends


def test_in_the_shell_they_run_as_well_and_their_ends_are_explained(folder: Path, ros_domain: int) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "tui", "shell", "-c", IN_THE_SHELL],
        cwd=folder,
        env={**os.environ, "SHELL": "/bin/bash", "ROS_DOMAIN_ID": str(ros_domain)},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert own_words(done.stdout).splitlines() == [f"{file} 1" for file in FILES], done.stderr
    for file in FILES:
        *_, last = own_words((folder / f"{file}.log").read_text()).splitlines()
        assert last.startswith(f"{file}:"), last
        # One that a busy machine has not brought as far as rclpy.spin ends by Ctrl-C itself.
        assert CTRL_C in last or (END in last and file != "hello.py"), last

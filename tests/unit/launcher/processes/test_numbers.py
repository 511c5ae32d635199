"""Numbers of processes are given again: ends and signals are for one very process."""

from __future__ import annotations

import pytest

from tests.own_numbers import run_with_own_numbers

pytestmark = pytest.mark.machine("namespaces")


def test_an_end_that_is_kept_is_not_that_of_whoever_gets_the_number() -> None:
    """The end of an orphan, and then a node with its number: the node is not told dead."""
    told = run_with_own_numbers(
        """
        import asyncio, os, signal
        from launcher.processes.exit import Reaper
        from launcher.processes.table import read_process

        async def main():
            reaper = Reaper()
            orphan = os.fork()
            if orphan == 0:
                os._exit(7)
            os.waitid(os.P_PID, orphan, os.WEXITED | os.WNOWAIT)
            first = read_process(orphan).started_ticks
            reaper.collect()
            while True:  # The clock of starts has ticks of 10 ms.
                give_next(orphan)
                node = os.fork()
                if node == 0:
                    signal.pause()
                second = read_process(node).started_ticks
                if second != first:
                    break
                os.kill(node, signal.SIGKILL)
                os.waitpid(node, 0)
            print(orphan == node)
            ended = reaper.exit_of(node, second)
            print(ended.done(), reaper.exit_of(orphan, first).result())
            os.kill(node, signal.SIGKILL)
            os.waitid(os.P_PID, node, os.WEXITED | os.WNOWAIT)
            reaper.collect()
            print(ended.result())

        asyncio.run(main())
        """
    )
    assert told.splitlines() == [
        "True",
        "False Exit(code=7, signal=None)",
        "Exit(code=None, signal='SIGKILL')",
    ]


def test_a_signal_is_not_for_whoever_has_got_the_number() -> None:
    told = run_with_own_numbers(
        """
        import os, signal, time
        from launcher.processes.signal import lives, send
        from launcher.processes.table import read_process

        def sleeper():
            pid = os.fork()
            if pid == 0:
                signal.pause()
            return pid

        meant = read_process(sleeper())
        print(lives(meant))
        send(meant, signal.SIGKILL)
        os.waitpid(meant.pid, 0)
        time.sleep(0.02)  # The clock of starts has ticks of 10 ms.
        give_next(meant.pid)
        other = read_process(sleeper())
        print(other.pid == meant.pid, lives(meant))
        send(meant, signal.SIGKILL)
        print(os.waitpid(other.pid, os.WNOHANG))
        send(other, signal.SIGTERM)
        print(os.waitpid(other.pid, 0)[1] == signal.SIGTERM)
        """
    )
    assert told.splitlines() == ["True", "True False", "(0, 0)", "True"]


def test_a_signal_goes_out_where_there_is_nothing_to_hold_a_process_by() -> None:
    told = run_with_own_numbers(
        """
        import errno, os, signal
        from launcher.processes.signal import send
        from launcher.processes.table import read_process

        def refuse(pid):
            raise OSError(errno.ENOSYS, "no such call")

        os.pidfd_open = refuse
        pid = os.fork()
        if pid == 0:
            signal.pause()
        send(read_process(pid), signal.SIGTERM)
        print(os.waitpid(pid, 0)[1] == signal.SIGTERM)
        """
    )
    assert told == "True\n"


def test_whoever_gets_the_number_of_a_node_is_not_one_of_it() -> None:
    told = run_with_own_numbers(
        """
        import os, signal, time
        from launcher.processes.members import Members
        from launcher.processes.table import read_process

        def leader():
            pid = os.fork()
            if pid == 0:
                os.setsid()
                signal.pause()
            while os.getsid(pid) != pid:
                time.sleep(0.001)
            return read_process(pid)

        members = Members("run")
        node = leader()
        members.add("sonar", node)
        print([each.pid == node.pid for each in members.scan()["sonar"]])
        os.kill(node.pid, signal.SIGKILL)
        os.waitpid(node.pid, 0)
        time.sleep(0.02)  # The clock of starts has ticks of 10 ms.
        give_next(node.pid)
        other = leader()
        print(other.pid == node.pid, members.scan())
        """
    )
    assert told.splitlines() == ["[True]", "True {}"]

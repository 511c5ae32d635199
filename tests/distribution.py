"""How the files of tests are handed to the processes of a run, of which one may die.

As `--dist loadfile` of pytest-xdist does, without three faults of it (seen with 3.8): the test in
which a process died was run again, and with a hang of ROS each of twenty processes one after the
other died in it; a process that had not collected its tests yet was given some (KeyError); and who
got one test alone waited for the next before it began.

And some files are run one at a time, after all others: whole robots, whose nodes are judged by the
clock, and a browser that draws in 3D. Each keeps a core busy, and has too little beside others.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from xdist.scheduler.loadfile import LoadFileScheduling

if TYPE_CHECKING:
    from collections.abc import Sequence

    from xdist.workermanage import WorkerController

_FEW = 2
"""A process that has no more tests than this left is given another file; it looks one ahead."""


ALONE = (
    "tests/ros/view/test_page_in_a_browser.py",
    "tests/ros/graph/test_findings_of_a_robot.py",
    "tests/ros/robot/test_model_drives.py",
    "tests/ros/course/test_lessons.py",
)
"""Run last, in this order, one at a time and with nothing beside them."""


class EachTestOnce(LoadFileScheduling):
    """Hands out whole files, and after the death of a process what it has not begun."""

    alone: Sequence[str] = ALONE

    def remove_node(self, node: WorkerController) -> str | None:
        """Forget a process; return the test in which it died, None if it had ended."""
        workload = self.assigned_work[node]
        died_in = next((test for tests in workload.values() for test in tests if not tests[test]), None)
        if died_in is not None:
            scope = self._split_scope(died_in)
            workload[scope][died_in] = True
        left = {scope: tests for scope, tests in workload.items() if not all(tests.values())}
        del self.assigned_work[node]
        self.workqueue.update(left)
        for other in self.assigned_work:
            self._reschedule(other)
        return died_in

    def mark_test_complete(self, node: WorkerController, item_index: int, duration: float = 0) -> None:
        """Keep that a test is done; whoever is left may have waited for it."""
        super().mark_test_complete(node, item_index, duration)
        for other in self.assigned_work:
            self._reschedule(other)

    def _assign_work_unit(self, node: WorkerController) -> None:
        if next(iter(self.workqueue)) not in self.alone or self._is_alone(node):
            super()._assign_work_unit(node)

    def _reschedule(self, node: WorkerController) -> None:
        while (
            node in self.registered_collections
            and not node.shutting_down
            and self._pending_of(self.assigned_work[node]) <= _FEW
        ):
            if next(iter(self.workqueue), "") in self.alone and not self._is_alone(node):
                # It ends once it has run what it has; the last one waits for the others.
                if self._others(node):
                    node.shutdown()
                return
            super()._reschedule(node)

    def _others(self, node: WorkerController) -> list[WorkerController]:
        """Return the other processes that are to go on."""
        return [one for one in self.assigned_work if one is not node and not one.shutting_down]

    def _is_alone(self, node: WorkerController) -> bool:
        """Whether no other process runs a test, or will."""
        return not self._others(node) and not any(
            self._pending_of(work) for one, work in self.assigned_work.items() if one is not node
        )

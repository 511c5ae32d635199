"""What has been found to keep a node from its work, if it lasts."""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable
    from types import CodeType, FrameType

DEADLOCK_S = 3.0
"""How long it may last if it cannot end by itself, such as waiting for the answer to a `call`."""
STUCK_S = 30.0
"""How long any other callback may run before it counts as stuck; it is reported if it goes on."""
UNSPUN_S = 15.0
"""How long the main thread may take before it spins, or a service before somebody offers it."""
_UNOFFERED_LOOKS = 2
"""What nobody has offered at so many looks was not offered when it was asked."""


class Finding:
    """A callback that runs, a wait, a main thread that has not spun yet, a node left alone."""

    def __init__(
        self, key: object, name: str, place: tuple[str, int], waits_in: str, bound_s: float, subject: object = None
    ) -> None:
        """`key`: the same as long as it is the same finding; `subject`: about the same thing."""
        self.key = key
        self.name = name
        self.file, self.line = place
        self.waits_in = waits_in
        """What it waits in, or else what is wrong: see `launcher.faults.stuck.MENDS`."""
        self.bound_s = bound_s
        self.subject = subject
        self.awaited: tuple[str, str] | None = None
        """`service` or `action`, and the name of it."""
        self.offered = False
        """Whether somebody offers what it waits for."""
        self.long: CodeType | None = None
        """The callback, if that it runs is reported early: nothing else is done meanwhile."""
        self.reported_in = ""
        self.proof: Callable[[], bool] = lambda: True
        """Asked once it has lasted: whether it can be nothing else."""
        self.ran_s = 0.0
        self.stuck = False
        self.unoffered_looks = 0

    @classmethod
    def at(cls, kind: str, frame: FrameType, own: FrameType, waits_in: str, bound_s: float) -> Finding:
        """Return what is found in a frame, of which the learner's own frame `own` is reported."""
        place = own.f_code.co_filename, own.f_lineno
        return cls((kind, frame), own.f_code.co_name, place, waits_in, bound_s)

    def follow(self, earlier: Finding | None, passed_s: float) -> None:
        """Take over what was known of it at the look before."""
        if earlier is not None and earlier.subject is self.subject:
            self.ran_s, self.stuck = earlier.ran_s + passed_s, earlier.stuck
            if self.waits_in == LOST != earlier.waits_in:
                self.stuck = False  # It is reported again, in other words.
            self.unoffered_looks = earlier.unoffered_looks
        self.unoffered_looks += self.awaited is not None and not self.offered
        if self.offered and not self._was_asked_in_vain:
            self.ran_s, self.stuck = 0.0, False

    @property
    def _was_asked_in_vain(self) -> bool:
        return self.waits_in == LOST and self.unoffered_looks >= _UNOFFERED_LOOKS

    def has_lasted(self) -> bool:
        """Whether it has lasted for too long, and is proven."""
        if self.stuck or self.ran_s < self.bound_s:
            return False
        self.stuck = self.proof()
        # What is not now is looked at once more when so long has passed again.
        self.ran_s = self.ran_s if self.stuck else 0.0
        return self.stuck


NOBODY, LOST = "nobody", "lost"
"""Nobody offers it; somebody does, but not when it was asked."""

"""What can go wrong in the launcher, as exceptions with sentences for people.

::

    LauncherError                   anything below; its text is fit to be shown as it is
    ├── UsageError                  what was asked for cannot be right, nothing was started (exit 2)
    │   ├── ProfileError            a profile that cannot be used; `.problems`, all of them
    │   ├── ProfileNotFoundError    no profile of that name; `.near` has the likely ones
    │   ├── DomainError             no ROS domain: not a number from 0 to 232
    │   ├── DomainTakenError        another session is in the domain; `.free` is one without
    │   └── UnknownNodeError        the running profile has no node of that name
    ├── RunDirError                 no run or log directory, or it is not ours, or full (exit 2)
    └── SessionError                about a running supervisor (exit 1)
        ├── NotRunningError         none runs, or none of that name
        ├── SeveralRunningError     more than one runs, choose by name; `.names` (exit 2)
        ├── AlreadyRunningError     the same profile runs there already; `.session` (exit 2)
        ├── StartError              the supervisor ended before it answered (exit 2)
        ├── ConnectionLostError     the supervisor has gone, or does not answer
        ├── SilentSupervisorError   it does not answer, and was left alone or killed
        └── ProtocolError           the other end speaks another version of the protocol
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from text.sentences import Words, say

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from launcher.status import SessionInfo


class LauncherError(Exception):
    """Anything that the launcher refuses or fails at."""

    exit_code = 1
    """What a command that ends by this error exits with."""


class UsageError(LauncherError):
    """The request cannot be right; nothing was started."""

    exit_code = 2


@dataclass(frozen=True)
class ProfileProblem:
    """One thing that is wrong in a profile.

    `line` and `column` count from 1; 0 where there is no place to point at. `message` and `hint`
    are `text.sentences.Words` wherever they come from this project.
    """

    file: str
    line: int
    column: int
    field: str
    """Path of the field: `nodes.sonar_front.params.rate`; empty for the file as a whole."""
    message: str
    hint: str = ""
    """The mend: what was probably meant, what to write."""

    @property
    def where(self) -> str:
        """`file:line:column`, as editors and terminals make it clickable."""
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file

    @property
    def words(self) -> Words:
        """One line: where, which field, what is wrong, how to mend it."""
        field = "{field}: " if self.field else ""
        hint = " ({hint})" if self.hint else ""
        values = {"field": self.field, "message": self.message, "hint": self.hint}
        return Words("{where}: " + field + "{message}" + hint, {"where": self.where, **values})

    def __str__(self) -> str:
        """The same, in English."""
        return str(self.words)


class ProfileError(UsageError):
    """A profile that cannot be used; every problem that was found, in order of place."""

    def __init__(self, problems: Iterable[ProfileProblem]) -> None:
        """Keep `problems`, of which there is at least one."""
        self.problems: tuple[ProfileProblem, ...] = tuple(problems)
        super().__init__(*(problem.words for problem in self.problems))

    def __str__(self) -> str:
        """One problem a line."""
        return "\n".join(map(str, self.problems))


class ProfileNotFoundError(UsageError):
    """No profile of that name."""

    def __init__(self, name: str, near: Sequence[str] = ()) -> None:
        """`near`: names that were probably meant."""
        self.name = name
        self.near = tuple(near)
        if near:
            words = say(
                "no profile {name!r}; did you mean {near}?", name=name, near=", ".join(near)
            )
        else:
            words = say("no profile {name!r}; `deck list` shows them all", name=name)
        super().__init__(words)


class DomainError(UsageError):
    """Not a valid ROS domain."""


class DomainTakenError(UsageError):
    """Another session of this user is in the domain."""

    def __init__(
        self, domain: int, sessions: Sequence[Words], free: int, *, can_share: bool
    ) -> None:
        """`sessions`: what there is in it; `free`: a domain without any.

        `can_share`: whether both could be in it, and would only hear each other.
        """
        self.domain = domain
        self.sessions = tuple(sessions)
        self.free = free
        self.can_share = can_share
        first, more = sessions[0], len(sessions) - 1
        super().__init__(
            say(
                "in domain {domain} there is already {first} (and {more} more);"
                " `--domain {free}` is free",
                domain=domain,
                first=first,
                more=more,
                free=free,
            )
            if more
            else say(
                "in domain {domain} there is already {first}; `--domain {free}` is free",
                domain=domain,
                first=first,
                free=free,
            )
        )


class UnknownNodeError(UsageError):
    """The running profile has no node of that name."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        """`known`: the nodes that there are."""
        self.name = name
        self.known = tuple(known)
        nodes = ", ".join(self.known)
        super().__init__(say("no node {name!r}; there are: {nodes}", name=name, nodes=nodes))


class RunDirError(LauncherError):
    """The run or log directory cannot be made or written, or is somebody else's."""

    exit_code = 2


class SessionError(LauncherError):
    """About a running supervisor."""


class NotRunningError(SessionError):
    """No session runs, or none of that name."""

    def __init__(self, name: str | None = None, running: Sequence[str] = ()) -> None:
        """`name`: what was asked for; `running`: what there is."""
        self.name = name
        if name is None:
            words = say("nothing runs in the background; `deck up PROFILE` starts a profile")
        elif running:
            names = ", ".join(running)
            words = say("{name!r} is not running; running: {names}", name=name, names=names)
        else:
            words = say("{name!r} is not running, nor is anything else", name=name)
        super().__init__(words)


class SeveralRunningError(SessionError):
    """More than one runs: choose by name."""

    exit_code = 2

    def __init__(self, names: Sequence[str]) -> None:
        """`names`: what runs."""
        self.names = tuple(names)
        super().__init__(
            say("several profiles run, choose one by name: {names}", names=", ".join(names))
        )


class AlreadyRunningError(SessionError):
    """The same nodes, or others that drive the same wheels, run already in that domain."""

    exit_code = 2

    def __init__(
        self, session: SessionInfo, run_dir: str = "", down: str = "deck down", free: int = 0
    ) -> None:
        """`session`: the one that runs; `run_dir`: its run directory if it is not ours.

        `down`: what stops it; `free`: a domain in which there is no session.
        """
        self.session = session
        self.free = free
        values: dict[str, object] = {
            "name": session.name,
            "domain": session.domain,
            "pid": session.supervisor_pid,
            "down": down,
            "free": free,
        }
        if run_dir:
            words = say(
                "{name} is already running in domain {domain} (pid {pid}, run directory "
                "{run_dir}); `{down}` stops it, `--domain {free}` starts another beside it",
                run_dir=run_dir,
                **values,
            )
        else:
            words = say(
                "{name} is already running in domain {domain} (pid {pid}); `deck attach` shows "
                "it, `{down}` stops it, `--domain {free}` starts another beside it",
                **values,
            )
        super().__init__(words)


class StartError(SessionError):
    """The supervisor ended before it answered."""

    exit_code = 2


class ConnectionLostError(SessionError):
    """The supervisor has gone, or does not answer."""


class SilentSupervisorError(SessionError):
    """The supervisor does not answer; whoever asked has left it alone, or has killed it."""


class ProtocolError(SessionError):
    """The other end speaks another version of the protocol."""

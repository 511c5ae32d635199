"""`deck shell`: the user's own shell in the domain of the lesson, with `ros2` and Deck's Python.

The shell replaces this process, so its exit code, its signals and its terminal are its own. It
reads the user's settings as always; after them, a file of ours puts Deck's folders first on the
path again, shows lesson and domain in the prompt, and says what there is instead of programs such
as RViz.
"""

from __future__ import annotations

import os
import shlex
import shutil
import sys
import tempfile
from argparse import Namespace
from pathlib import Path

from cli.commands import Parser, command
from cli.domains import running_domain
from cli.options import add_graph
from launcher.domain.discovery import settings_of_discovery
from launcher.domain.domain import settings_of_domain
from launcher.errors import NotRunningError
from launcher.ros_tools import own_folders, ros_tools, without_wheels
from text.i18n import N_, _, localized
from text.output import say_error
from text.plain import plain
from text.sentences import say

KNOWN = ("bash", "zsh", "fish", "sh", "dash", "ksh")
LABEL = "DECK_SHELL"
"""The variable with what the prompt shows; it also tells that a shell is one of Deck's."""
OWN_PATH = "DECK_SHELL_PATH"
_BASH = """\
[ -r ~/.bashrc ] && . ~/.bashrc
PATH=$DECK_SHELL_PATH:$PATH
PS1="($DECK_SHELL) $PS1"
"""
_ZSH = """\
ZDOTDIR=$DECK_ZDOTDIR
[[ -r $ZDOTDIR/.zshrc ]] && source $ZDOTDIR/.zshrc
PATH=$DECK_SHELL_PATH:$PATH
PS1="($DECK_SHELL) $PS1"
"""
_ZSH_ENV = """\
[[ -r $DECK_ZDOTDIR/.zshenv ]] && ZDOTDIR=$DECK_ZDOTDIR source $DECK_ZDOTDIR/.zshenv
ZDOTDIR=$DECK_OWN_ZDOTDIR
"""
_FISH = """\
set -gx PATH (string split : -- $DECK_SHELL_PATH) $PATH
functions -c fish_prompt deck_prompt_before
function fish_prompt; printf '(%s) ' $DECK_SHELL; deck_prompt_before; end
"""
_SH = """\
[ -n "$DECK_ENV" ] && [ -r "$DECK_ENV" ] && . "$DECK_ENV"
PATH=$DECK_SHELL_PATH:$PATH
PS1="($DECK_SHELL) ${PS1-$ }"
"""
_SPACE = N_("the Space tab and `deck view` show frames, models and what sensors see")
_GRAPH = N_("the Flow and Graph tabs show who speaks to whom")
_SIMULATED = N_("`deck run robot` drives a simulated robot")
_DEPENDENCIES = N_("what the lessons need is here; other packages need a ROS 2 of your own")
_TYPES = N_("ROS 2 has `ros2 interface show`")
INSTEAD = {
    "rviz2": _SPACE, "rviz": _SPACE,
    "rqt": _GRAPH, "rqt_graph": _GRAPH,
    "rqt_console": N_("the Logs tab and `deck logs` show what the nodes log"),
    "rqt_plot": N_("the Topics tab shows values as they come"),
    "rqt_image_view": N_("the Topics tab shows pictures"),
    "plotjuggler": N_("the Topics tab shows values as they come"),
    "gazebo": _SIMULATED, "gz": _SIMULATED, "ign": _SIMULATED, "gzserver": _SIMULATED,
    "rosdep": _DEPENDENCIES, "vcs": _DEPENDENCIES,
    "rosbag": N_("`ros2 bag`, or `deck record` and `deck replay`"),
    "roscore": N_("ROS 2 has no master: nodes find each other by themselves"),
    "roslaunch": N_("a profile starts the nodes of a lesson together: `deck run`"),
    "rosrun": N_("ROS 2 has `ros2 run`"),
    "rostopic": N_("ROS 2 has `ros2 topic`"),
    "rosnode": N_("ROS 2 has `ros2 node`"),
    "rosservice": N_("ROS 2 has `ros2 service`"),
    "rosparam": N_("ROS 2 has `ros2 param`"),
    "rosmsg": _TYPES, "rossrv": _TYPES,
    "catkin_make": N_("ROS 2 builds with `colcon build`"),
    "catkin": N_("ROS 2 builds with `colcon build`"),
}  # fmt: skip
"""By the name of the program: what there is in its place, as a sentence to be translated."""
_NOT_FOUND = """\
deck_instead() {{
case $1 in
{cases}
*) return 1 ;;
esac
}}
"""
_NOT_FOUND_BASH = """\
if declare -F command_not_found_handle >/dev/null; then
eval "deck_not_found_before$(declare -f command_not_found_handle | sed '1s/[^ (]*//')"
else
deck_not_found_before() { printf '%s: command not found\\n' "$1" >&2; return 127; }
fi
command_not_found_handle() { deck_instead "$1" && return 127; deck_not_found_before "$@"; }
"""
_NOT_FOUND_ZSH = """\
if (( $+functions[command_not_found_handler] )); then
functions[deck_not_found_before]=$functions[command_not_found_handler]
else
deck_not_found_before() { print -u2 "zsh: command not found: $1"; return 127 }
fi
command_not_found_handler() { deck_instead "$1" && return 127; deck_not_found_before "$@" }
"""
_NOT_FOUND_FISH = """\
functions -q fish_command_not_found; and functions -c fish_command_not_found deck_not_found_before
function fish_command_not_found
switch $argv[1]
{cases}
case '*'
functions -q deck_not_found_before; and deck_not_found_before $argv
end
end
"""


def _shell_options(parser: Parser) -> None:
    parser.add_argument("profile", nargs="?", metavar=_("PROFILE"), help=_("by default the lesson that is running"))
    parser.add_argument("-c", dest="line", metavar=_("LINE"), help=_("run this command line and end"))
    add_graph(parser, _("ROS domain; by default that of the running robot"))
    parser.epilog = _("The shell is that of SHELL. The exit code is that of the shell or command.")


@command("shell", _shell_options)
def shell_command(options: Namespace) -> int:
    """Become the shell; return only if that is impossible."""
    name, domain, discovery = _place(options)
    environ = environment_in(domain, discovery)
    if options.lang:
        environ["DECK_LANG"] = options.lang
    in_domain = _("domain {domain}").format(domain=domain)
    label = in_domain if name == f"domain-{domain}" else f"{name}, {in_domain}"
    environ[LABEL] = plain(label, 80)
    shell = _shell(environ)
    if options.line is not None:
        argv = [shell, "-c", options.line]
    elif not sys.stdin.isatty():
        argv = [shell]
    else:
        argv = _interactive(shell, environ)
        words = _("ROS domain {domain}; `ros2 topic list` shows its topics, `exit` leaves")
        say_error(words.format(domain=domain))
    sys.stdout.flush()
    try:
        os.execve(shell, argv, environ)
    except OSError as error:
        say_error(f"deck: {shell}: {error.strerror}")
    return 127


def _place(options: Namespace) -> tuple[str, int, str | tuple[str, ...]]:
    """Return name, domain and discovery: of the lesson asked for, else of the one that runs."""
    if options.profile is None:
        return running_domain(options.domain, options.discovery)
    from launcher.client.running import find_running

    try:
        session = find_running(options.profile).session
    except NotRunningError:
        from launcher.profile.catalog import find_profile
        from launcher.profile.load import load_profile

        profile = load_profile(find_profile(options.profile), domain=options.domain)
        return profile.name, profile.domain, options.discovery or profile.discovery
    return session.name, session.domain, options.discovery or session.discovery


def environment_in(domain: int, discovery: str | tuple[str, ...]) -> dict[str, str]:
    """Return the variables for programs of another ROS: of this process, of ROS, and ours."""
    environ = dict(os.environ)
    changes: dict[str, str | None] = {
        **settings_of_domain(domain, discovery),
        **without_wheels(environ),
        **settings_of_discovery(environ, discovery),
        **ros_tools(environ),
    }
    for variable, value in changes.items():
        if value is None:
            environ.pop(variable, None)
        else:
            environ[variable] = value
    return environ


def _shell(environ: dict[str, str]) -> str:
    """Return the path of the user's shell if its ways are known here, else of sh."""
    wanted = environ.get("SHELL", "")
    if Path(wanted).name in KNOWN and os.access(wanted, os.X_OK):
        return wanted
    return shutil.which("sh") or "/bin/sh"


def _interactive(shell: str, environ: dict[str, str]) -> list[str]:
    """Return the command line of the shell; what it must read at its start is written to files."""
    kind = Path(shell).name
    ours = os.pathsep.join(own_folders(environ))
    environ[OWN_PATH] = ours
    folder = Path(tempfile.gettempdir()) / f"deck-shell-{os.getuid()}-{os.getpid()}"
    folder.mkdir(mode=0o700)
    # The shell replaces this process, so nobody is left to remove them: the files do it themselves.
    gone = f"rm -rf -- {shlex.quote(str(folder))}\n"
    if kind == "bash":
        (folder / "bashrc").write_text(gone + _BASH + _functions() + _NOT_FOUND_BASH, encoding="utf-8")
        return [shell, "--rcfile", str(folder / "bashrc"), "-i"]
    if kind == "zsh":
        environ["DECK_ZDOTDIR"] = environ.get("ZDOTDIR", environ.get("HOME", "/"))
        environ["DECK_OWN_ZDOTDIR"] = environ["ZDOTDIR"] = str(folder)
        (folder / ".zshenv").write_text(_ZSH_ENV, encoding="utf-8")
        (folder / ".zshrc").write_text(gone + _ZSH + _functions() + _NOT_FOUND_ZSH, encoding="utf-8")
        return [shell, "-i"]
    if kind == "fish":
        folder.rmdir()
        return [shell, "--init-command", _FISH + _for_fish(), "-i"]
    environ["DECK_ENV"] = environ.get("ENV", "")
    environ["ENV"] = str(folder / "shrc")
    again = 'ENV=$DECK_ENV; unset DECK_ENV; [ -n "$ENV" ] || unset ENV\n'
    (folder / "shrc").write_text(gone + _SH + again, encoding="utf-8")
    return [shell, "-i"]


def _for_fish() -> str:
    cases = (f"case {name}\necho {shlex.quote(line)} >&2" for name, line in _lines())
    return _NOT_FOUND_FISH.format(cases="\n".join(cases))


def _functions() -> str:
    cases = (f"{name}) echo {shlex.quote(line)} >&2 ;;" for name, line in _lines())
    return _NOT_FOUND.format(cases="\n".join(cases))


def _lines() -> list[tuple[str, str]]:
    return [
        (name, localized(say("{name} is not in Deck: {instead}", name=name, instead=say(words))))
        for name, words in INSTEAD.items()
    ]

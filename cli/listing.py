"""`deck list` and `deck check`: the available profiles, and what is wrong with them."""

from __future__ import annotations

import sys
from argparse import Namespace
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

from cli.commands import Parser, command
from cli.options import add_json, add_profile_options
from launcher.errors import ProfileError, ProfileProblem
from launcher.profile.catalog import find_profile, list_profiles
from launcher.profile.defaults import shown
from launcher.profile.load import Profile, faults_of, load_profile
from text.i18n import _, localized, ngettext, pick
from text.output import DIM, RED, YELLOW, Paint, json_text, write
from text.plain import plain


@command("list", add_json)
def list_command(options: Namespace) -> int:
    """Show all profiles, broken ones with their first problem."""
    entries = list_profiles()
    if options.json:
        names = ("name", "path", "title", "about", "lesson", "nodes", "panels", "error")
        told = [{**{name: getattr(entry, name) for name in names}, "path": str(entry.path)} for entry in entries]
        write(json_text(told, indent=2))
        return 0
    width = max((len(entry.name) for entry in entries), default=0)
    paint = Paint(sys.stdout)
    for entry in entries:
        name = plain(entry.name).ljust(width)
        if entry.error:
            first = localized(entry.problems[0].words) if entry.problems else plain(entry.error)
            broken = paint(_("broken"), RED)
            write(f"{name}  {broken}: {first}")
            continue
        nodes = paint(_("nodes: {names}").format(names=", ".join(entry.nodes)), DIM)
        write(f"{name}  {pick(entry.title)}")
        write(f"{'':{width}}  {nodes}")
    return 0


def _check_options(parser: Parser) -> None:
    parser.add_argument("profile", nargs="?", metavar=_("PROFILE"), help=_("name or file; all of them by default"))
    parser.add_argument(
        "--preflight",
        action="store_true",
        help=_("check the devices too, with --hardware real: found, permitted, free, answering"),
    )
    add_json(parser)
    add_profile_options(parser)
    parser.epilog = _("Exit code: 0 if everything is all right, else 2. Nothing is moved.")


@command("check", _check_options)
def check_command(options: Namespace) -> int:
    """Report problems of one profile, of all, or of devices; return 0 if there are none."""
    if options.preflight:
        from cli.preflight.devices import preflight_command

        return preflight_command(options)
    paths = [find_profile(options.profile)] if options.profile else [entry.path for entry in list_profiles()]
    if options.json:
        found = {path: _problems(path, options)[1:] for path in paths}
        told = [
            {"path": str(path), "problems": [*map(asdict, problems)], "warnings": [*map(asdict, warnings)]}
            for path, (problems, warnings) in found.items()
        ]
        write(json_text(told, indent=2))
        return 2 if any(problems for problems, _warnings in found.values()) else 0
    return max([_check(path, options) for path in paths], default=0)


def _problems(
    path: Path, options: Namespace
) -> tuple[Profile | None, Sequence[ProfileProblem], Sequence[ProfileProblem]]:
    """Return a profile, if it can be loaded, what is wrong with it, and warnings."""
    try:
        profile = load_profile(path, hardware=options.hardware, overrides=options.overrides, domain=options.domain)
    except ProfileError as error:
        return None, error.problems, ()
    return profile, faults_of(profile), profile.warnings


def _check(path: Path, options: Namespace) -> int:
    paint = Paint(sys.stdout)
    profile, problems, warnings = _problems(path, options)
    for problem in problems:
        write(_line(problem, paint, RED))
    for problem in warnings:
        write(_line(problem, paint, YELLOW, _("warning") + ": "))
    if profile is None or problems:
        return ProfileError.exit_code
    count = len(profile.nodes)
    nodes = ngettext("{count} node", "{count} nodes", count).format(count=count)
    well = _("all is well")
    write(f"{plain(shown(path))}: {well}, {nodes}")
    return 0


def _line(problem: ProfileProblem, paint: Paint, colour: str, kind: str = "") -> str:
    words = localized(problem.words)
    where = plain(f"{problem.where}: ")
    return paint(where, colour) + kind + words.removeprefix(where)

"""`deck check PROFILE --hardware real --preflight`: one line per device, with the fix."""

from __future__ import annotations

import sys
from argparse import Namespace

from cli.doctor.command import show
from cli.doctor.finding import Level
from launcher.errors import UsageError
from launcher.profile.catalog import find_profile
from launcher.profile.load import load_profile
from text.i18n import _, ngettext
from text.output import Paint, json_text, write
from text.plain import plain
from text.sentences import say

NOT_READY = 2


def preflight_command(options: Namespace) -> int:
    """Check every device of a profile; return 2 if one of them is not ready.

    Raises:
        UsageError: without a profile, or with mock hardware, whose devices exist only while it
            runs.
    """
    if not options.profile:
        raise UsageError(say("--preflight needs a profile: deck check robot --preflight"))
    if options.hardware != "real":
        raise UsageError(say("--preflight checks real devices: add --hardware real"))
    profile = load_profile(
        find_profile(options.profile), hardware=options.hardware, overrides=options.overrides, domain=options.domain
    )
    from cli.preflight.devices import examine

    findings = examine(profile)
    bad = sum(finding.level is Level.FAIL for finding in findings)
    if options.json:
        write(json_text([finding.for_programs() for finding in findings], indent=2))
        return NOT_READY if bad else 0
    if not findings:
        write(_("{name} has no devices").format(name=plain(profile.name)))
        return 0
    show(findings, Paint(sys.stdout))
    if not bad:
        write(_("every device answers; nothing was moved"))
        return 0
    words = ngettext(
        "{count} device is not ready; nothing was moved", "{count} devices are not ready; nothing was moved", bad
    )
    write(words.format(count=bad))
    return NOT_READY

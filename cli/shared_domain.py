"""Warning, on the command line, that a profile is about to share its domain."""

from __future__ import annotations

from typing import TYPE_CHECKING

from launcher.errors import DomainTakenError
from launcher.runs.shared_domain import apart_from_classmates, refuse_shared_domain
from text.i18n import _, localized
from text.output import say_error

if TYPE_CHECKING:
    from launcher.profile.load import Profile


def in_own_domain(profile: Profile) -> Profile:
    """Return the profile in the domain it is to run in, and say what has to be said of it."""
    settled = apart_from_classmates(profile)
    if settled.domain != profile.domain:
        words = _("somebody else on this account is in domain {taken}: this one runs in domain {domain}")
        say_error(words.format(taken=profile.domain, domain=settled.domain))
    warn_of_shared_domain(settled)
    return settled


def warn_of_shared_domain(profile: Profile) -> None:
    """Name other sessions in the domain; the supervisor refuses those that exclude each other."""
    try:
        refuse_shared_domain(profile)
    except DomainTakenError as taken:
        if taken.can_share:
            say_error(localized(taken.args[0]))
            say_error(_("their nodes will see each other"))

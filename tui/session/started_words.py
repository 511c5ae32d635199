"""Who has started a session, where and when, in a sentence."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from launcher.processes.owner import who_words
from text.i18n import _, localized
from text.plain import plain

if TYPE_CHECKING:
    from launcher.status import SessionInfo


def started_words(session: SessionInfo) -> str:
    """Say who has started a session, where and when."""
    who = plain(localized(who_words(session.started_by)), 200)
    since = time.strftime("%H:%M", time.localtime(session.since_s))
    if session.foreground:
        return _("On another screen: {who}, since {since}").format(who=who, since=since)
    return _("In the background, started by {who} at {since}").format(who=who, since=since)

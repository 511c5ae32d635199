"""Why a panel is empty, in words: four different troubles, four different messages."""

from __future__ import annotations

from graph.data import Trouble
from text.figures import elapsed
from text.i18n import N_, _

_HEADLINES = {
    Trouble.NO_PUBLISHER: N_("nobody publishes this topic"),
    Trouble.QOS_MISMATCH: N_("QoS is incompatible: not everybody is heard"),
    Trouble.UNKNOWN_TYPE: N_("message type is not installed"),
    Trouble.QUIET: N_("there is a publisher, but nothing has come yet"),
}


def trouble_words(trouble: Trouble, age_s: float | None = None) -> str:
    """Headline for an empty panel; `age_s` is the age of the newest message, if one ever came."""
    if trouble is Trouble.QUIET and age_s is not None:
        return no_data_words(age_s)
    return _(_HEADLINES[trouble])


def no_data_words(age_s: float) -> str:
    """Say for how long nothing has come: whole seconds, minutes from two of them on."""
    if age_s < 120:
        return _("no data for {seconds} s").format(seconds=elapsed(age_s))
    return _("no data for {minutes} min").format(minutes=elapsed(age_s / 60))

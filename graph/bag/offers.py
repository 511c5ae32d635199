"""The QoS that a recorded publisher offered, from any version of rosbag2.

Up to version 8 of the metadata it is YAML in a text, with the numbers of rmw's enumerations; from
version 9 on it is a list, with names. MCAP and SQLite files hold the text of either.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from text.nested_yaml import read_yaml

RELIABILITIES = ("system_default", "reliable", "best_effort", "unknown", "best_available")
"""By their number in rmw's `rmw_qos_reliability_policy_e`."""
DURABILITIES = ("system_default", "transient_local", "volatile", "unknown", "best_available")
"""By their number in rmw's `rmw_qos_durability_policy_e`."""
_USED = {"reliable", "best_effort", "transient_local", "volatile"}


class Offer(NamedTuple):
    """What the first publisher offered; empty where that is not known."""

    reliability: str = ""
    durability: str = ""


def offer_in(profiles: object) -> Offer:
    """Return the first of some recorded profiles; an empty one if they cannot be understood."""
    if isinstance(profiles, str):
        profiles = _loaded(profiles)
    first = profiles[0] if isinstance(profiles, list) and profiles else None
    if not isinstance(first, dict):
        return Offer()
    return Offer(_named(first.get("reliability"), RELIABILITIES), _named(first.get("durability"), DURABILITIES))


def _loaded(text: str) -> Any:  # noqa: ANN401 - whatever the YAML holds
    import yaml

    try:
        return read_yaml(text)
    except (yaml.YAMLError, ValueError):
        return None


def _named(value: object, names: tuple[str, ...]) -> str:
    """Return the name of a policy that a publisher can offer, else nothing."""
    if isinstance(value, int) and 0 <= value < len(names):
        value = names[value]
    name = str(value).lower()
    return name if name in _USED else ""

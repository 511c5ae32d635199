"""What /head_state must show while the head of lesson 3 turns."""

import itertools
import math

LONGEST_SILENCE_S = 0.9
SHORTEST_MOVEMENT_S = 0.8
LONGEST_MOVEMENT_S = 3.0
NOT_THERE = {
    "en": "/head_state does not show the angles that were asked for",
    "ru": "в /head_state нет углов, которые были запрошены",
}


def takes_a_second(seen):
    """Between the arrivals of two requests, one after the other, a movement has passed."""
    first_s = _arrived(seen, 2)
    second_s = _arrived(seen, 3)
    if second_s is not None and first_s is None:
        return {
            "en": "both requests were answered in no time: no servo is that fast",
            "ru": "на оба запроса ответ пришёл мгновенно: таких быстрых сервоприводов нет",
        }
    if first_s is None or second_s is None:
        return NOT_THERE
    took_s = second_s - first_s
    if took_s < SHORTEST_MOVEMENT_S:
        return {
            "en": f"the head was there within {SHORTEST_MOVEMENT_S} s: no servo is that fast",
            "ru": f"голова была на месте раньше чем через {SHORTEST_MOVEMENT_S} с: таких быстрых "
            "сервоприводов нет",
        }
    if took_s > LONGEST_MOVEMENT_S:
        return {
            "en": f"the head took more than {LONGEST_MOVEMENT_S:g} s instead of 1 s",
            "ru": f"поворот занял больше {LONGEST_MOVEMENT_S:g} с вместо 1 с",
        }
    return None


def never_silent(seen):
    """/head_state has come all the time that the movement took."""
    there_s = _arrived(seen, 4)
    if there_s is None:
        return NOT_THERE
    times = [time_s for time_s, _ in seen.messages["/head_state"]]
    # What the node did before it turned, or was started anew, is no part of the movement.
    silent = any(
        later - sooner >= LONGEST_SILENCE_S
        and sooner < there_s
        and later > there_s - SHORTEST_MOVEMENT_S
        for sooner, later in itertools.pairwise([-math.inf, *times])
    )
    if not silent:
        return None
    return {
        "en": "/head_state was silent while the head turned",
        "ru": "/head_state молчал, пока голова поворачивалась",
    }


def _arrived(seen, tilt_deg):
    """When the head was first told to be at this tilt."""
    return next(
        (
            time_s
            for time_s, message in seen.messages["/head_state"]
            if len(message["position"]) == 2
            and abs(message["position"][1] - math.radians(tilt_deg)) < 0.002
        ),
        None,
    )

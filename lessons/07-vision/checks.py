"""How often the agent of lesson 7 looks."""

import re

SIZE = re.compile(r"\d+x\d+")
SHORTEST_S, LONGEST_S = 2.0, 5.0


def seldom(seen):
    """Tell whether the agent logs about a picture every three seconds."""
    looks_s = sorted(
        logged_s for logged_s, line in seen.logged["vlm_agent"] if SIZE.search(line["text"])
    )
    if len(looks_s) < 2:
        return {
            "en": "the agent has not looked twice so far",
            "ru": "агент ещё не посмотрел второй раз",
        }
    after_s = looks_s[-1] - looks_s[-2]
    if SHORTEST_S <= after_s <= LONGEST_S:
        return None
    return {
        "en": f"the agent looks again after {after_s:.0f} s; 3 s is wanted",
        "ru": f"агент смотрит снова через {after_s:.0f} с, а нужно через 3 с",
    }

"""What makes the brain of lesson 9 act, and what does not."""

WORD_OF_BEFORE = 1
"""The voice of the step before may be answered as late as now."""


def no_word_for_a_distance(seen):
    """Several distances have come; they start nothing."""
    words = [message["data"] for _, message in seen.messages["/ai_command"]]
    if len(words) <= WORD_OF_BEFORE:
        return None
    # How many have come by now is chance.
    return {
        "en": f"distances came and no voice, and /ai_command said {words[-1]}",
        "ru": f"пришли расстояния, голоса не было, а в /ai_command — {words[-1]}",
    }

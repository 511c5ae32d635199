"""What makes the brain of lesson 9 act, and what does not."""

AT_MOST = 2
"""The answer, and one to the voice of the check before, which may come as late as now."""


def one_word_for_a_voice(seen):
    """One voice was heard, and distances keep coming, which start nothing."""
    words = [message["data"] for _, message in seen.messages["/ai_command"]]
    if len(words) <= AT_MOST:
        return None
    # How many have come by now is chance.
    return {
        "en": f"one voice was heard, and /ai_command keeps saying {words[-1]}: distances start it",
        "ru": f"голос был один, а в /ai_command раз за разом — {words[-1]}: по расстояниям",
    }

"""What the log of lesson 1 must look like."""

import re

GREETING = re.compile("hello|привет", re.IGNORECASE)


def greets(seen):
    """The node has said hello to its log."""
    # Both nodes are this file; the greeting of the one that starts first may come too early.
    lines = [line for node in ("hello", "hello_fast") for _time, line in seen.logged[node]]
    greetings = [line for line in lines if GREETING.search(line["text"])]
    if any(line["severity"] == "info" for line in greetings):
        return None
    if greetings:
        severity = greetings[-1]["severity"]
        return {
            "en": f"the greeting is logged, with the severity {severity} and not info: "
            "use self.get_logger().info(...)",
            "ru": f"приветствие записано в журнал с уровнем {severity}, а не info: "
            "нужен self.get_logger().info(...)",
        }
    if any(GREETING.search(text) for text in seen.logs["hello"]):
        return {
            "en": "the greeting is only printed, hello has not logged it: "
            "use self.get_logger().info(...)",
            "ru": "приветствие только напечатано, hello не записал его в журнал: "
            "нужен self.get_logger().info(...)",
        }
    if lines:
        # It is the same in each run.
        first = lines[0]["text"]
        return {
            "en": f"no line with hello or привет; the first one: {first}",
            "ru": f"нет строки со словом «привет» или hello; первая: {first}",
        }
    return {"en": "hello logs nothing", "ru": "hello ничего не пишет в журнал"}


def counts_seconds(seen):
    """The node has logged three numbers in a row, a second apart."""
    return counts(seen, "hello", 1.0)


def counts_faster(seen):
    """The second node of the same file counts four times a second."""
    return counts(seen, "hello_fast", 0.25)


def counts(seen, node, period_s):
    """The newest numbers that a node has logged follow each other at this period."""
    numbered = [
        (logged_s, numbers)
        for logged_s, line in seen.logged[node]
        if line["severity"] == "info"
        and (numbers := {int(each) for each in re.findall(r"(?<!ROS )\d+", line["text"])})
    ][-3:]
    if len(numbered) < 3:
        return {
            "en": f"{node} has logged fewer than three lines with a number",
            "ru": f"в журнале {node} меньше трёх строк с числом",
        }
    (first_s, first), (_, second), (third_s, third) = numbered
    if not any(n + 1 in second and n + 2 in third for n in first):
        by = max(second) - max(first)
        return {
            "en": f"{node} does not count 1, 2, 3: from line to line the number grows by {by}",
            "ru": f"{node} не считает 1, 2, 3: от строки к строке число растёт на {by}",
        }
    found_s = (third_s - first_s) / 2
    if not 0.6 * period_s <= found_s <= 1.6 * period_s:
        about_s = round(found_s * 4) / 4 or 0.1
        return {
            "en": f"{node} counts every {about_s:g} s, not every {period_s:g} s",
            "ru": f"{node} считает каждые {about_s:g} с, а не каждые {period_s:g} с",
        }
    return None

"""What the log of lesson 1 must look like."""

import re

INFO = 20
SEVERITIES = {10: "debug", 20: "info", 30: "warning", 40: "error", 50: "fatal"}


def greets(seen):
    """The node has said hello to its log."""
    # Both nodes are this file; the greeting of the one that starts first may come too early.
    nodes = ("hello", "hello_fast")
    lines = [line["msg"] for node in nodes for _time, line in logged(seen, node)]
    # The first: it is the same in each run.
    if any(re.search("hello|привет", text, re.IGNORECASE) for text in lines):
        return None
    others = [
        SEVERITIES.get(line["level"], "?")
        for _time, line in seen.messages["/rosout"]
        if line["name"] in nodes and re.search("hello|привет", line["msg"], re.IGNORECASE)
    ]
    if others:
        return {
            "en": f"the greeting is logged, with the severity {others[-1]} and not info: "
            "use self.get_logger().info(...)",
            "ru": f"приветствие записано в журнал с уровнем {others[-1]}, а не info: "
            "нужен self.get_logger().info(...)",
        }
    if any(re.search("hello|привет", text, re.IGNORECASE) for text in seen.logs["hello"]):
        return {
            "en": "the greeting is only printed, hello has not logged it: "
            "use self.get_logger().info(...)",
            "ru": "приветствие только напечатано, hello не записал его в журнал: "
            "нужен self.get_logger().info(...)",
        }
    if lines:
        return {
            "en": f"no line with hello or привет; the first one: {lines[0]}",
            "ru": f"нет строки со словом «привет» или hello; первая: {lines[0]}",
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
        for logged_s, line in logged(seen, node)
        if (numbers := {int(each) for each in re.findall(r"(?<!ROS )\d+", line["msg"])})
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


def logged(seen, node):
    """What a node has logged: when, and the message."""
    lines = [
        (line["stamp"]["sec"] + line["stamp"]["nanosec"] / 1e9, line)
        for _, line in seen.messages["/rosout"]
        if line["name"] == node and line["level"] == INFO
    ]
    return sorted(lines, key=lambda each: each[0])

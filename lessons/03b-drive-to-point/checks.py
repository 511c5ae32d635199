"""How a drive of lesson 3b must end."""

import math

LARGEST_ERROR_M = 0.15


def stood_where_it_said(seen):
    """The drive has ended at the goal, with a stop."""
    if not seen.messages["/odom"] or not seen.messages["/drive"]:
        return {"en": "nothing has moved", "ru": "ничего не двигалось"}
    place = seen.messages["/odom"][-1][1]["pose"]["pose"]["position"]
    left_m = math.hypot(-seen.values["x_m"] - place["x"], seen.values["y_m"] - place["y"])
    if left_m > LARGEST_ERROR_M:
        return {
            "en": "the result says reached, but the robot is more than "
            f"{LARGEST_ERROR_M} m away from the goal",
            "ru": f"в результате reached, но до цели ещё больше {LARGEST_ERROR_M} м",
        }
    speed = float(seen.messages["/drive"][-1][1]["drive"]["speed"])
    if speed:
        return {
            "en": f"the goal is reached, but the last command on /drive is {speed:.1f} m/s: stand",
            "ru": f"цель достигнута, но последняя команда в /drive — {speed:.1f} м/с: нужен stand",
        }
    return None

"""What the robot does, seen from its topics."""

import math

DRIVE, SAFE, ODOM, SONAR = "/drive", "/drive_safe", "/odom", "/sensor/sonar_front"
STILL = 1e-3
SETTLE_S, STOP_BELOW_M = 0.3, 0.5
"""How long the gate may take to react, and to what."""
STEADY_S, LATE_S = 0.5, 0.2
"""How long before a word the measurements must agree, and after it: some arrive late."""


def speeds(seen):
    """Return the speeds on /drive, in order."""
    return [message["drive"]["speed"] for _, message in seen.messages[DRIVE]]


def repeats(seen):
    """Tell whether a word is repeated for two seconds, ten times in each."""
    times = [when for when, message in seen.messages[DRIVE] if message["drive"]["speed"] < 0]
    if len(times) < 2 or times[-1] - times[0] < 1.4:
        return {
            "en": "/drive did not come for two seconds after the word",
            "ru": "после слова сообщения в /drive не шли две секунды",
        }
    rate = (len(times) - 1) / (times[-1] - times[0])
    if not 7 <= rate <= 13:
        return {
            "en": f"/drive comes {rate:.0f} times a second, not 10",
            "ru": f"в /drive приходит {rate:.0f} сообщений в секунду, а не 10",
        }
    return None


def ends_with_a_stop(seen):
    """Tell whether the last word of the driver is a stop, after some motion."""
    said = speeds(seen)
    if not said or max(map(abs, said)) < STILL:
        return {"en": "nothing that moves came on /drive", "ru": "в /drive не пришло движения"}
    if abs(said[-1]) > STILL:
        return {
            "en": f"the last speed on /drive is {said[-1]:.2f} m/s, not 0",
            "ru": f"последняя скорость в /drive — {said[-1]:.2f} м/с, а не 0",
        }
    first = next(when for when, message in seen.messages[DRIVE] if message["drive"]["speed"])
    lasted = seen.messages[DRIVE][-1][0] - first
    if not 1.4 <= lasted <= 3.5:
        return {
            "en": f"the stop came {lasted:.0f} s after the first message, not 2 s",
            "ru": f"остановка пришла через {lasted:.0f} с после первого сообщения, а не через 2 с",
        }
    return None


def moves(seen):
    """Tell whether the robot has moved by its odometry, and stands again."""
    places = [message["pose"]["pose"]["position"] for _, message in seen.messages[ODOM]]
    if len(places) < 2:
        return {"en": "no odometry comes", "ru": "одометрия не приходит"}
    start = places[0]
    if max(math.hypot(at["x"] - start["x"], at["y"] - start["y"]) for at in places) < 0.1:
        return {
            "en": "the robot has moved by less than 0.1 m",
            "ru": "робот проехал меньше 0.1 м",
        }
    return still_drives(seen)


def still_drives(seen):
    """Return with which speed the robot drives; None if it stands."""
    speed = seen.messages[ODOM][-1][1]["twist"]["twist"]["linear"]["x"]
    if abs(speed) < 0.02:
        return None
    return {
        "en": f"the robot still drives, {speed:.1f} m/s",
        "ru": f"робот всё ещё едет, {speed:.1f} м/с",
    }


def decides(seen):
    """Tell whether each word fits what the sonar has said, where that can be told."""
    words = seen.messages["/ai_command"]
    if not words:
        return {"en": "no word came on /ai_command", "ru": "в /ai_command не пришло слова"}
    told = [(message["data"], path_clear(seen, when)) for when, message in words]
    sure = [(word, clear) for word, clear in told if clear is not None]
    if not sure:
        return {
            "en": "while words came, the sonar said now clear, now not clear",
            "ru": "пока приходили слова, по сонару путь был то свободен, то нет",
        }
    for word, clear in sure:
        if word != ("вперед" if clear else "стоп"):
            return {
                "en": f"the word is {word}, and the sonar says {'clear' if clear else 'not clear'}",
                "ru": f"слово — {word}, а по сонару путь {'свободен' if clear else 'не свободен'}",
            }
    return None


def path_clear(seen, when):
    """Return whether the path was clear around this time; None where the sonar said both.

    By which measurement a word was chosen nobody sees: the robot may be driving, and one
    measurement in a thousand fails, and is nan.
    """
    told = seen.messages[SONAR]
    if not told or told[0][0] > when - STEADY_S:
        return None
    around = {
        message["data"] >= 1.0 for time, message in told if when - STEADY_S <= time <= when + LATE_S
    }
    return around.pop() if len(around) == 1 else None


def stands_before_the_wall(seen):
    """Tell whether the robot stands, in front of something, and not in it."""
    odometry, distances = seen.messages[ODOM], seen.messages[SONAR]
    if len(odometry) < 2 or not distances:
        return {"en": "no odometry or distance comes", "ru": "нет одометрии или расстояния"}
    nearest = min((each["data"] for _, each in distances if each["data"] > 0), default=math.inf)
    if drives := still_drives(seen):
        return drives
    if nearest < 0.2:
        return {
            "en": "the robot came nearer than 0.2 m",
            "ru": "робот подъехал ближе чем на 0.2 м",
        }
    return None


def nothing_before_the_wall(seen):
    """Tell whether the gate lets no forward speed through while the sonar says that a wall is near."""
    distances = [(when, message["data"]) for when, message in seen.messages[SONAR]]
    if not distances or not seen.messages[SAFE]:
        return {"en": "no distances or no commands came", "ru": "не пришли расстояния или команды"}
    for when, message in seen.messages[SAFE]:
        speed = message["drive"]["speed"]
        # What the sonar said before the gate had to have reacted, and since then.
        known = [metres for said, metres in distances if said <= when - SETTLE_S][-1:]
        since = [metres for said, metres in distances if when - SETTLE_S < said <= when]
        if speed > STILL and known and max(known + since) < STOP_BELOW_M:
            return {
                "en": f"/drive_safe lets {speed:.2f} m/s through with an obstacle nearer than {STOP_BELOW_M} m",
                "ru": f"/drive_safe пропускает {speed:.2f} м/с, хотя препятствие ближе {STOP_BELOW_M} м",
            }
    return None

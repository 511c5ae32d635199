"""What /wheel_commands must show when /drive falls silent, in lesson 4b."""

import itertools

COMMANDS = 6
ALMOST_SILENT_S = 0.4


def drives_on_until_silence(seen):
    """While commands come the wheels turn; half a second after the last they stand."""
    commands = [
        (time_s, [float(each) for each in message["velocity"][:2]])
        for time_s, message in seen.messages["/wheel_commands"]
    ]
    asked = seen.values["last_m_s"]
    driven_s = [time_s for time_s, speeds in commands if _is(speeds, asked)]
    if len(driven_s) < COMMANDS:
        return {
            "en": f"{COMMANDS} commands came on /drive, and fewer on /wheel_commands",
            "ru": f"команд в /drive было {COMMANDS}, в /wheel_commands — меньше",
        }
    stops_s = [time_s for time_s, speeds in commands if _is(speeds, 0.0)]
    if any(
        before_s < time_s < after_s
        for before_s, after_s in itertools.pairwise(driven_s)
        if after_s - before_s < ALMOST_SILENT_S
        for time_s in stops_s
    ):
        return {
            "en": "the wheels were stopped between two commands: each must reset the timer",
            "ru": "колёса остановлены между двумя командами: каждая должна сбрасывать таймер",
        }
    after_s = [time_s - driven_s[-1] for time_s in stops_s if time_s > driven_s[-1]]
    if not after_s:
        return {
            "en": f"the wheels still turn at {asked} m/s, although nobody drives any more",
            "ru": f"колёса всё ещё крутятся со скоростью {asked} м/с, хотя команд больше нет",
        }
    if after_s[0] < 0.3:
        return {
            "en": f"the wheels were stopped {after_s[0]:.1f} s after the last command, not 0.5 s",
            "ru": f"колёса остановлены через {after_s[0]:.1f} с после команды, а не 0.5 с",
        }
    if after_s[0] > 2.0:
        return {
            "en": "the wheels were stopped more than 2 s after the last command",
            "ru": "колёса остановлены больше чем через 2 с после последней команды",
        }
    return None


def _is(speeds, wanted):
    return len(speeds) == 2 and all(abs(speed - wanted) < 0.002 for speed in speeds)

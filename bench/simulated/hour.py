"""An hour of simulated driving among boxes: collisions with and without the gate.

`python -m bench.simulated.hour` prints a table. The driver changes direction at random; commands
are noisy and occasionally NaN or infinite, sonars fall silent for up to a second and drop
readings, motors stall. A collision counts as avoidable if the obstacle was in the beam of the
sonar on that side. If the robot is boxed in, it is moved to another place.
"""

from __future__ import annotations

import time

from robot.safety.distance import SafetyZone
from robot.world.room import LIVING_ROOM
from robot.world.world import World
from tests.unit.random_driver import RandomDriver

HOUR_S = 3600.0
GATES = {
    "the robot's gate: stop at 0.5 m, slower from 1.0 m": SafetyZone(0.5, 1.0, 0.5),
    "a later one: stop at 0.3 m, no slowing down": SafetyZone(0.3, 0.0, 0.3),
    "no gate": None,
}


def main() -> None:
    """Drive an hour with each gate."""
    print("| | driven m | collisions | of these avoidable by a stop | took s |")
    print("| --- | --- | --- | --- | --- |")
    for name, zone in GATES.items():
        driver = RandomDriver(World(LIVING_ROOM, seed=3), seed=4, zone=zone)
        began_s = time.monotonic()
        driver.drive_for(HOUR_S)
        took_s, world = time.monotonic() - began_s, driver.world
        figures = f"{driver.driven_m:.0f} | {world.collisions} | {driver.avoidable}"
        print(f"| {name} | {figures} | {took_s:.0f} |", flush=True)


if __name__ == "__main__":
    main()

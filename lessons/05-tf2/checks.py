"""Where the camera sits on the robot, by /tf_static."""

PARENT, CHILD, PLACE = "base_link", "camera_link", (0.15, 0.0, 0.25)
NEAR = 0.001
"""Metres, and as much of a quaternion."""


def place(seen):
    """Tell whether the frame is at its place, not turned; the newest counts."""
    sent = [each for _, message in seen.messages["/tf_static"] for each in message["transforms"]]
    ours = [each for each in sent if each["child_frame_id"] == CHILD]
    if not ours:
        return {"en": f"nobody publishes the frame {CHILD}", "ru": f"систему координат {CHILD} никто не публикует"}
    parent, transform = ours[-1]["header"]["frame_id"], ours[-1]["transform"]
    if parent != PARENT:
        return {
            "en": f"{CHILD} is in {parent}, not in {PARENT}",
            "ru": f"{CHILD} задана в {parent}, а не в {PARENT}",
        }
    moved = [transform["translation"][axis] for axis in "xyz"]
    if not all(abs(got - wanted) <= NEAR for got, wanted in zip(moved, PLACE, strict=True)):
        found = ", ".join(f"{each:.3f}" for each in moved)
        return {"en": f"the translation is {found} m", "ru": f"сдвиг — {found} м"}
    turned = transform["rotation"]
    if not (abs(turned["w"]) >= 1 - NEAR and all(abs(turned[axis]) <= NEAR for axis in "xyz")):
        found = ", ".join(f"{axis} = {turned[axis]:.3f}" for axis in "xyzw")
        return {"en": f"it is turned: {found}", "ru": f"она повёрнута: {found}"}
    return None

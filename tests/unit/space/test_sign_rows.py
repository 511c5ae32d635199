"""Texts over a picture: none over another, and none that jumps from picture to picture."""

from __future__ import annotations

from space.drawing.sign_rows import SignRows

WIDE = "front_left_wheel"


def written(
    *signs: tuple[str, int, int], before: dict[str, int | None] | None = None
) -> dict[str, int | None]:
    """Write texts, given with their row and column, in a picture of ten rows."""
    rows = SignRows(10, before or {})
    for text, row, column in signs:
        rows.write(row, column, text, 1, text)
    for one in rows.written:
        for other in rows.written:
            apart = one.row != other.row or one.column + len(one.text) < other.column
            assert one is other or apart or other.column + len(other.text) < one.column
    return rows.moved


def test_the_first_keeps_its_place_and_others_go_close_by_or_are_left_out() -> None:
    texts = [f"frame_{number}" for number in range(7)]
    moved = written(*((text, 4, 10) for text in texts))
    assert list(moved.values()) == [0, 1, -1, 2, -2, None, None]
    assert written(("top", 0, 3), ("below", 0, 3), ("beside", 0, 20)) == {
        "top": 0,
        "below": 1,
        "beside": 0,
    }


def test_a_text_goes_back_to_its_row_only_when_there_is_room_about_it() -> None:
    moved = written((WIDE, 4, 10), ("arm", 4, 20))
    assert moved["arm"] == 1
    for column in (27, 28, 29):
        moved = written((WIDE, 4, 10), ("arm", 4, column), before=moved)
        assert moved["arm"] == 1
    moved = written((WIDE, 4, 10), ("arm", 4, 30), before=moved)
    assert moved["arm"] == 0
    # Once there it stays as long as nothing is below it.
    assert written((WIDE, 4, 10), ("arm", 4, 27), before=moved)["arm"] == 0


def test_a_text_that_was_left_out_comes_back_only_when_there_is_room_about_it() -> None:
    wall = tuple((f"{WIDE}_{row}", row, 10) for row in range(10))
    assert written(*wall, ("arm", 4, 12))["arm"] is None
    assert written(*wall, ("arm", 4, 29), before={"arm": None})["arm"] is None
    assert written(*wall, ("arm", 4, 29))["arm"] == 0
    assert written(*wall, ("arm", 4, 40), before={"arm": None})["arm"] == 0


def test_a_text_stays_in_the_row_that_it_was_moved_to() -> None:
    signs = (("base", 4, 10), ("arm", 4, 10))
    assert written(*signs)["arm"] == 1
    assert written(*signs, before={"base": 0, "arm": -2})["arm"] == -2
    # Where it was is taken.
    taken = (("base", 4, 10), ("lid", 2, 10), ("arm", 4, 10))
    assert written(*taken, before={"arm": -2})["arm"] == 1


def test_what_has_no_name_is_written_and_not_remembered() -> None:
    rows = SignRows(3, {"": None})
    rows.write(1, 0, "?", 1, "")
    assert [one.text for one in rows.written] == ["?"]
    assert rows.moved == {}

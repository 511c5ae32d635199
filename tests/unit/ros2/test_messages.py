"""What a message looks like on a command line."""

from __future__ import annotations

from std_msgs.msg import Header, String

from ros2.messages import to_yaml


def test_a_text_beside_other_fields_begins_no_line_of_its_own_and_a_page_may_be_one() -> None:
    assert to_yaml(Header(frame_id="map\n---\nstamp: 0")).splitlines()[-1] == r'frame_id: "map\n---\nstamp: 0"'
    assert to_yaml(String(data="one\ntwo")) == "data: 'one\n\n  two'\n"
    assert to_yaml(String(data="a" * 9), 3) == "data: aaa...\n"

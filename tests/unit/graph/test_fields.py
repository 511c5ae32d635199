"""Field types as message classes name them."""

from __future__ import annotations

import pytest

from graph.messages.fields import FieldType, parse


@pytest.mark.parametrize(
    ("text", "kind"),
    [
        ("double", FieldType("double")),
        ("string<10>", FieldType("string", text_limit=10)),
        ("std_msgs/Header", FieldType("std_msgs/Header")),
        ("uint8[16]", FieldType("uint8", is_many=True, size=16)),
        ("sequence<octet>", FieldType("octet", is_many=True)),
        ("sequence<uint8, 16>", FieldType("uint8", is_many=True, limit=16)),
        ("sequence<wstring<3>, 5>", FieldType("wstring", is_many=True, limit=5, text_limit=3)),
        ("sequence<string<3>>", FieldType("string", is_many=True, text_limit=3)),
        ("string<4>[2]", FieldType("string", is_many=True, size=2, text_limit=4)),
        ("geometry_msgs/Point[8]", FieldType("geometry_msgs/Point", is_many=True, size=8)),
        ("sequence<geometry_msgs/Point>", FieldType("geometry_msgs/Point", is_many=True)),
    ],
)
def test_every_form_is_understood(text: str, kind: FieldType) -> None:
    assert parse(text) == kind
    assert kind.is_message == ("/" in text)

"""Files in other encodings than UTF-8: read as they declare, or told which they are not."""

from __future__ import annotations

import codecs

import pytest

from space.urdf import UrdfError, read_urdf, urdf_of

ARM = "рука"


def robot(declared: str = "") -> str:
    first = f'<?xml version="1.0" encoding="{declared}"?>' if declared else '<?xml version="1.0"?>'
    return f"{first}\n<robot name='rover'>\n  <link name='{ARM}'/></robot>"


@pytest.mark.parametrize(
    "raw",
    [
        robot().encode(),
        robot("UTF-8").encode(),
        robot("windows-1251").encode("windows-1251"),
        robot("KOI8-R").replace('"', "'").encode("koi8-r"),
        codecs.BOM_UTF8 + robot().encode(),
        robot("UTF-16").encode("utf-16"),
        robot().encode("utf-16"),
        codecs.BOM_UTF16_BE + robot("utf-16").encode("utf-16-be"),
        # Written by an editor that did not do what it declares.
        robot("utf-16").encode(),
        codecs.BOM_UTF8 + robot("windows-1251").encode(),
    ],
    ids=lambda _: "",
)
def test_a_file_is_read_as_it_declares_and_handed_on_as_utf_8(raw: bytes) -> None:
    text = urdf_of(raw)
    assert list(read_urdf(text).links) == [ARM]
    assert "encoding=" not in text or "UTF-8" in text.splitlines()[0]


@pytest.mark.parametrize(
    ("raw", "said"),
    [
        (robot().encode("windows-1251"), "line 3: the byte 0xF0 is not UTF-8; save the file as UTF-8, or declare"),
        (robot("utf-8").encode("koi8-r"), "line 3: the byte 0xD2 is not utf-8; save"),
        (robot("ASCII").encode(), "line 3: the byte 0xD1 is not ASCII; save"),
        (robot("klingon-8").encode(), "line 1: the declared encoding klingon-8 is not known"),
        (robot("base64").encode(), "line 1: the declared encoding base64 is not known"),
        (b"<robot>" + b" " * 2**23, "line 1: the text is longer than 4 MiB"),
    ],
    ids=lambda _: "",
)
def test_what_cannot_be_read_so_is_told_by_line_and_mend(raw: bytes, said: str) -> None:
    with pytest.raises(UrdfError) as told:
        urdf_of(raw)
    assert said in str(told.value)

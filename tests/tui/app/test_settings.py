"""What a person has settled: read, checked with clear words, kept."""

from __future__ import annotations

from pathlib import Path

import pytest

from tui.screens import every_action
from tui.settings import Settings, SettingsError, load, save

THEMES = {"textual-dark", "textual-light"}


def read(path: Path) -> Settings:
    return load(path, THEMES, every_action)


def test_what_is_saved_is_read_again(tmp_path: Path) -> None:
    path = tmp_path / "deck" / "settings.json"
    left_out = "sensor_msgs/msg/Image,sensor_msgs/msg/PointCloud2"
    settings = Settings("textual-light", "ru", {"node.restart": "f7"}, "05-tf2", left_out=left_out)
    save(path, settings)
    assert read(path) == settings
    assert [file.name for file in path.parent.iterdir()] == ["settings.json"]


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('{"theme": ', "settings.json:1:11: "),
        ("[]", "expected an object"),
        ('{"colour": "red"}', "unknown setting 'colour'; available: theme, language, keys, lesson"),
        ('{"theme": "pink"}', "theme: unknown value 'pink'; available: textual-dark, textual-light"),
        ('{"language": "fr"}', "language: unknown value 'fr'; available: en, ru"),
        ('{"theme": 7}', "theme: unknown value 7"),
        ('{"theme": []}', "theme: unknown value []"),
        ('{"left_out": "Image"}', "left_out: unknown value 'Image'; available: sensor_msgs/msg/"),
        ('{"left_out": [1]}', "left_out: unknown value [1]"),
        ('{"lesson": 5}', "lesson: expected the name of a profile"),
        ('{"keys": ["f7"]}', "keys: expected an object"),
        ('{"keys": {"node.dance": "f7"}}', "unknown action 'node.dance'"),
        ('{"keys": {"node.restart": 7}}', 'node.restart: expected a key such as "f7"'),
        ('{"keys": {"node.restart": " "}}', 'node.restart: expected a key such as "f7"'),
        ("\x00", "settings.json:1:1: "),
    ],
)
def test_a_broken_file_is_refused_with_place_and_mend(tmp_path: Path, text: str, words: str) -> None:
    path = tmp_path / "settings.json"
    path.write_text(text)
    with pytest.raises(SettingsError) as refused:
        read(path)
    assert str(path) in str(refused.value)
    assert words in str(refused.value)

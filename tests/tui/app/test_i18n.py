"""Two languages: which is spoken, and that Russian is complete and compiled."""

from __future__ import annotations

import gettext
from pathlib import Path

import pytest

from graph.data import ParameterRow
from graph.messages.types import UnknownTypeError, load_message
from tests.unit.scripts_of_setup import load
from text.i18n import detect, localized, ngettext, set_language
from tui.graph.parameters import allowed_words
from tui.yaml_form.words import reason_words

catalogues = load("catalogues")


@pytest.mark.parametrize(
    ("option", "environ", "settled", "spoken"),
    [
        ("ru", {"DECK_LANG": "en", "LANG": "en_US.UTF-8"}, "en", "ru"),
        (None, {"DECK_LANG": "ru", "LANG": "en_US.UTF-8"}, "en", "ru"),
        (None, {"LANG": "en_US.UTF-8"}, "ru", "ru"),
        (None, {"LC_MESSAGES": "ru_RU", "LANG": "en_US.UTF-8"}, "", "ru"),
        (None, {"LANG": "C.UTF-8"}, "", "en"),
        (None, {"LANG": "de_DE.UTF-8"}, "", "en"),
        (None, {}, "", "en"),
    ],
)
def test_the_nearest_wish_for_a_language_counts(
    option: str | None, environ: dict[str, str], settled: str, spoken: str
) -> None:
    assert detect(option, environ, settled) == spoken


def test_russian_counts_by_its_own_rules() -> None:
    set_language("ru")
    forms = [ngettext("Starts {n} node", "Starts {n} nodes", n).format(n=n) for n in (1, 2, 5, 11, 21)]
    assert forms == [
        "Запускает 1 узел",
        "Запускает 2 узла",
        "Запускает 5 узлов",
        "Запускает 11 узлов",
        "Запускает 21 узел",
    ]


def test_everything_said_is_translated_and_nothing_else() -> None:
    assert catalogues.wrong("ru") == []


def test_a_catalogue_is_compiled_when_its_source_has_changed(tmp_path: Path) -> None:
    folder = tmp_path / "ru" / "LC_MESSAGES"
    folder.mkdir(parents=True)
    source, made = folder / "deck.po", folder / "deck.mo"
    head = (catalogues.LOCALE / "ru" / "LC_MESSAGES" / "deck.po").read_text().split("\n\n")[0]
    for word in ("Выход", "Конец"):
        source.write_text(f'{head}\n\nmsgid "Quit"\nmsgstr "{word}"\n')
        assert catalogues.stale(tmp_path) == [source]
        catalogues.compile_stale(tmp_path)
        assert catalogues.stale(tmp_path) == []
        with made.open("rb") as file:
            assert gettext.GNUTranslations(file).gettext("Quit") == word
    assert sorted(folder.iterdir()) == [made, source]


def test_translations_fill_in_the_same_values() -> None:
    def fields(text: str) -> set[str]:
        return {part.split("}")[0].split(":")[0].split("!")[0] for part in text.split("{")[1:]}

    for entry in catalogues.translated("ru"):
        ids = entry.id if isinstance(entry.id, (tuple, list)) else (entry.id,)
        texts = entry.string if isinstance(entry.string, (tuple, list)) else (entry.string,)
        if entry.id:
            for text in texts:
                assert fields(text) <= fields(ids[0]) | fields(ids[-1]), entry.id


@pytest.mark.parametrize("name", ["std_msgs", "std_msgs/msg/Strin", "no_such_msgs/msg/Any", "std_msgs/srv/Any"])
def test_a_type_that_is_not_there(name: str) -> None:
    set_language("ru")
    with pytest.raises(UnknownTypeError) as found:
        load_message(name)
    for words in (localized(found.value.words), reason_words(found.value)):
        assert any("а" <= char <= "я" for char in words.lower())


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (ParameterRow("a", "double", 1.0, "", "0.1 .. 60 s", False, 0.1, 60.0), "0.1…60 с"),
        (ParameterRow("a", "integer", 1, "", "0 .. 9 rad/s", True, 0, 9), "только чтение, 0…9 рад/с"),
        (ParameterRow("a", "double", 1.0, "", "0 .. 1 furlong", False, 0.0, 1.0), "0…1 furlong"),
        (ParameterRow("a", "double", 1.0, "", "0 .. 2 s", False, 0.0, 1.0), "0…1, 0 .. 2 s"),
        (ParameterRow("a", "string", "", "", "text, may be empty"), "строка, может быть пустой"),
        (ParameterRow("a", "string", "", "", "as you like"), "as you like"),
    ],
)
def test_what_a_parameter_may_be(row: ParameterRow, words: str) -> None:
    set_language("ru")
    assert allowed_words(row) == words

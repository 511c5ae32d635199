# -*- coding: utf-8 -*-
"""What the set-up says, in the reader's language; it comes before the catalogues of text/locale.

It runs on any Python, even one far too old for Deck, as preflight.py does.
"""

import os
import sys

RUSSIAN = {
    # preflight.py
    "ROS 2 is on PyPI for 64-bit Linux on x86-64 only, this is %s on %s, %d-bit: %s.": (
        "в PyPI ROS 2 есть только для 64-разрядного Linux на x86-64, а это %s на %s, %d-разрядный: %s."
    ),
    "install pixi (https://pixi.sh) and use `pixi run deck`": (
        "установите pixi (https://pixi.sh) и запускайте `pixi run deck`"
    ),
    "the ROS 2 of PyPI needs glibc 2.28 or newer, which this Linux lacks: %s.": (
        "для ROS 2 из PyPI нужна glibc 2.28 или новее, в этом Linux её нет: %s."
    ),
    "this is Python %s and Deck runs on 3.10 to 3.13: install one of them.": (
        "это Python %s, а Deck работает на версиях с 3.10 по 3.13: установите одну из них."
    ),
    "Python %s cannot make virtual environments: sudo apt install python%s-venv.": (
        "Python %s не может создать виртуальное окружение: sudo apt install python%s-venv."
    ),
    "there is no C compiler: sudo apt install build-essential.": (
        "нет компилятора C: sudo apt install build-essential."
    ),
    "there is no C++ compiler: sudo apt install build-essential.": (
        "нет компилятора C++: sudo apt install build-essential."
    ),
    "Python %s lacks its headers: sudo apt install python%s-dev.": (
        "у Python %s нет заголовочных файлов: sudo apt install python%s-dev."
    ),
    # environment.py
    "deck: another `make` is setting up here, waiting for it": "deck: здесь уже идёт установка, жду её конца",
    "deck: setting up %s with Python %s": "deck: устанавливаю в %s, Python %s",
    "  1 to 3 minutes at first, more on a busy machine": ("  в первый раз 1–3 минуты, на занятой машине дольше"),
    "deck: set-up complete": "deck: установка завершена",
    "deck: failed at: %s; the whole log is in %s": "deck: не удалось: %s; весь журнал — в %s",
    "deck: nothing is built before these names are fixed": (
        "deck: пока эти имена не исправлены, ничего не собирается"
    ),
    "deck: cannot set up here: %s": "deck: здесь установить нельзя: %s",
    "deck: ROS=%s is neither jazzy nor kilted": "deck: ROS=%s — это не jazzy и не kilted",
    "\ndeck: set-up interrupted; the next `make` starts it again": (
        "\ndeck: установка прервана; следующий `make` начнёт её снова"
    ),
    "%s already exists and was not made by `make`; move it away": (
        "%s уже существует, и создал её не `make`; переместите её"
    ),
    "%s: CMake cannot build in a folder of that name; move it elsewhere": (
        "%s: CMake не может собирать в папке с таким именем; переместите её"
    ),
    "%s: killed by signal %d": "%s: процесс завершён сигналом %d",
    "Virtual environment": "Виртуальное окружение",
    "Libraries of Deck and ROS 2": "Библиотеки Deck и ROS 2",
    "Deck itself": "Сам Deck",
    "Message types": "Типы сообщений",
    "Message types, built meanwhile": "Типы сообщений (сборка шла параллельно)",
    "Installing the message types": "Установка типов сообщений",
    "kept from an earlier set-up": "остались от прошлой установки",
    "failed": "не удалось",
    "  %d of %d: %s ... ": "  %d из %d: %s ... ",
    "%d s": "%d с",
    # Makefile
    "deck: installing the viewers, 250 MB to load": "deck: устанавливаю просмотрщики, загрузка 250 МБ",
}


def speaks_russian():
    # type: () -> bool
    """Return whether the reader does, as `text.i18n.detect` has it without --lang and settings."""
    locale = os.environ.get("LC_ALL") or os.environ.get("LC_MESSAGES") or os.environ.get("LANG")
    for wish in (os.environ.get("DECK_LANG"), locale):
        code = (wish or "").replace("-", "_").split("_")[0].split(".")[0].lower()
        if code in ("en", "ru"):
            return code == "ru"
    return False


def told(text, *values):
    # type: (str, *object) -> str
    """Return a sentence in the reader's language."""
    words = RUSSIAN[text] if speaks_russian() else text
    return words % values if values else words


def tell(words):
    # type: (str) -> None
    """Write to standard error, which old Pythons would not trust with more than ASCII."""
    if sys.version_info < (3,):
        sys.stderr.write(words + "\n")  # bytes already
    else:
        sys.stderr.buffer.write(words.encode("utf-8", "replace") + b"\n")


if __name__ == "__main__":
    tell(told(sys.argv[1]))

"""A program that the set-up of its package has put elsewhere is found, with the lines to write."""

from __future__ import annotations

from pathlib import Path

import pytest

from ros2.main import main

SCRIPT = "#!/usr/bin/python3\nfrom {package}.talk import main\n"
OLD = "#!/usr/bin/python3\n# EASY-INSTALL-ENTRY-SCRIPT: '{package}==0.0.0'\n"


@pytest.fixture
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """One with a package of no programs."""
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "my_pkg").touch()
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return tmp_path


@pytest.mark.parametrize(("folder", "text"), [("bin", SCRIPT), ("bin", OLD), ("lib/copied_from", SCRIPT)])
def test_where_it_is_and_what_is_missing_are_told(
    folder: str, text: str, prefix: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (prefix / folder).mkdir(parents=True)
    (prefix / folder / "talk").write_text(text.format(package="my_pkg"))
    assert main(["run", "my_pkg", "talk"]) == 1
    told = capsys.readouterr().err
    assert f"talk was installed into {prefix}/{folder}/, and is looked for in lib/my_pkg/" in told
    assert told.endswith("\n[develop]\nscript_dir=$base/lib/my_pkg\n[install]\ninstall_scripts=$base/lib/my_pkg\n")


@pytest.mark.parametrize("package", ["not_my_pkg", "my_pkg_too"])
def test_the_program_of_another_package_is_not_meant(
    package: str, prefix: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (prefix / "bin").mkdir()
    (prefix / "bin" / "talk").write_text(SCRIPT.format(package=package))
    (prefix / "bin" / "look").write_bytes(b"\x7fELF\xff my_pkg.")
    for name in ("talk", "look", "none"):
        assert main(["run", "my_pkg", name]) == 1
        assert capsys.readouterr().err == "No executable found\n"

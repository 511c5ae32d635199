"""Manifests, registered components, and what stands in the place of the tutorials' packages."""

from __future__ import annotations

from pathlib import Path

import pytest

from ros2.main import main

MANIFEST = """\
<package format="3"><name>mine</name><version>1.2.3</version>
<depend>rclpy</depend><depend>std_msgs</depend></package>
"""


@pytest.fixture(autouse=True)
def prefix(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A prefix with one package."""
    index = tmp_path / "share/ament_index/resource_index"
    for kind, text in (("packages", ""), ("rclcpp_components", "mine::Talker;lib/libmine.so\n")):
        (index / kind).mkdir(parents=True)
        (index / kind / "mine").write_text(text)
    (tmp_path / "share/mine").mkdir()
    (tmp_path / "share/mine/package.xml").write_text(MANIFEST)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))
    return tmp_path


def test_the_manifest_of_a_package(capsys: pytest.CaptureFixture[str], prefix: Path) -> None:
    assert main(["pkg", "xml", "mine"]) == 0
    assert capsys.readouterr().out == MANIFEST
    assert main(["pkg", "xml", "mine", "-t", "depend"]) == 0
    assert capsys.readouterr().out == "rclpy\nstd_msgs\n"
    assert main(["pkg", "xml", "mine", "--tag", "url"]) == 1
    assert main(["pkg", "xml", "nothing"]) == 1
    assert "Package not found" in capsys.readouterr().err
    (prefix / "share/mine/package.xml").write_text("<package")
    assert main(["pkg", "xml", "mine"]) == 1
    assert "The manifest of 'mine' cannot be read" in capsys.readouterr().err


def test_components_that_are_registered(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["component", "types"]) == 0
    assert "mine\n  mine::Talker\n" in capsys.readouterr().out
    assert main(["component", "types", "mine"]) == 0
    assert capsys.readouterr().out == "mine::Talker\n"
    assert main(["component", "types", "other"]) == 1


@pytest.mark.parametrize(
    ("package", "instead"), [("demo_nodes_cpp", "deck new --node"), ("rviz2", "deck view")]
)
def test_packages_of_tutorials_are_told_with_what_there_is(
    package: str, instead: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["run", package, "talker"]) == 1
    told = capsys.readouterr().err
    assert told.startswith(f"Package '{package}' not found. ")
    assert instead in told

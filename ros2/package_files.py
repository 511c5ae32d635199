"""The files of a new package of nodes in Python, as colcon and ament want them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

if TYPE_CHECKING:
    from collections.abc import Mapping


@dataclass(frozen=True)
class Package:
    """What is asked for."""

    name: str
    package_format: int
    description: str
    license: str
    maintainer: str
    email: str
    dependencies: tuple[str, ...]
    node: str
    """The name of a first node; empty: none."""


def files(package: Package) -> Mapping[str, str]:
    """Return path -> content."""
    name = package.name
    found = {
        "package.xml": _manifest(package),
        "setup.py": _setup(package),
        "setup.cfg": CONFIG.format(name=name),
        f"resource/{name}": "",
        f"{name}/__init__.py": "",
        "test/test_copyright.py": _test("copyright", "errors", "argv=['.', 'test']"),
        "test/test_flake8.py": _FLAKE8,
        "test/test_pep257.py": _test("pep257", "code style errors", "argv=['.', 'test']"),
    }
    if package.node:
        found[f"{name}/{package.node}.py"] = _NODE.format(name=name)
    return found


def _manifest(package: Package) -> str:
    version = package.package_format
    schema = f"http://download.ros.org/schema/package_format{version}.xsd"
    depends = "".join(f"  <depend>{escape(name)}</depend>\n" for name in package.dependencies)
    tests = ("ament_copyright", "ament_flake8", "ament_pep257", "python3-pytest")
    tested = "".join(f"  <test_depend>{name}</test_depend>\n" for name in tests)
    return (
        '<?xml version="1.0"?>\n'
        f'<?xml-model href="{schema}" schematypens="http://www.w3.org/2001/XMLSchema"?>\n'
        f'<package format="{version}">\n'
        f"  <name>{package.name}</name>\n"
        "  <version>0.0.0</version>\n"
        f"  <description>{escape(package.description)}</description>\n"
        f"  <maintainer email={quoteattr(package.email)}>"
        f"{escape(package.maintainer)}</maintainer>\n"
        f"  <license>{escape(package.license)}</license>\n\n"
        f"{depends}{chr(10) if depends else ''}{tested}\n"
        "  <export>\n    <build_type>ament_python</build_type>\n  </export>\n</package>\n"
    )


def _setup(package: Package) -> str:
    entry = f"            '{package.node} = {package.name}.{package.node}:main',\n" if package.node else ""
    return _SETUP.format(
        name=package.name,
        maintainer=package.maintainer,
        email=package.email,
        description=package.description,
        license=package.license,
        entry=entry,
    )


def _test(tool: str, found: str, call: str) -> str:
    return _TEST.format(tool=tool, found=found, call=call)


CONFIG = """\
[develop]
script_dir=$base/lib/{name}
[install]
install_scripts=$base/lib/{name}
"""
"""setup.cfg: without it, setuptools puts programs into bin/."""

_SETUP = """\
from setuptools import find_packages, setup

package_name = {name!r}

setup(
    name=package_name,
    version='0.0.0',
    packages=find_packages(exclude=['test']),
    data_files=[
        ('share/ament_index/resource_index/packages', ['resource/' + package_name]),
        ('share/' + package_name, ['package.xml']),
    ],
    install_requires=['setuptools'],
    zip_safe=True,
    maintainer={maintainer!r},
    maintainer_email={email!r},
    description={description!r},
    license={license!r},
    extras_require={{'test': ['pytest']}},
    entry_points={{
        'console_scripts': [
{entry}        ],
    }},
)
"""

_NODE = """\
def main():
    print('Hi from {name}.')


if __name__ == '__main__':
    main()
"""

_TEST = """\
from ament_{tool}.main import main
import pytest


@pytest.mark.{tool}
@pytest.mark.linter
def test_{tool}():
    assert main({call}) == 0, 'Found {found}'
"""

_FLAKE8 = """\
from ament_flake8.main import main_with_errors
import pytest


@pytest.mark.flake8
@pytest.mark.linter
def test_flake8():
    code, errors = main_with_errors(argv=[])
    assert code == 0, '\\n'.join(errors)
"""

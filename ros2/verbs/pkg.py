"""`ros2 pkg`: the programs of installed packages, and a new package of nodes in Python, ready for `colcon build`."""

from __future__ import annotations

import getpass
import re
from argparse import ArgumentTypeError
from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape, quoteattr

from ros2.packages import CONFIG, NoPackageError, executables, packages
from ros2.verb import arg, flag, verb

if TYPE_CHECKING:
    from argparse import Namespace
    from collections.abc import Iterator


@verb(
    "pkg executables", "Output a list of package specific executables",
    arg("package_name", nargs="?", help="The package name"),
    flag("--full-path", help="Show the full path of each executable"),
)  # fmt: skip
def list_executables(args: Namespace) -> str | None:
    """Print package and program, or the path of each."""
    names = sorted(packages()) if args.package_name is None else [args.package_name]
    for package in names:
        try:
            paths = sorted(executables(package), key=lambda path: path.name)
        except NoPackageError:
            return f"Package '{package}' not found"
        for path in paths:
            print(path if args.full_path else f"{package} {path.name}")
    return None


def _name(text: str) -> str:
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", text):
        raise ArgumentTypeError(f"'{text}' is not a name: letters, digits and _ after a letter")
    return text


@verb(
    "pkg create", "Create a new ROS 2 package", arg("package_name", type=_name, help="The package name"),
    arg("--description", default="TODO: Package description", help="The description given in the package.xml"),
    arg("--license", default="TODO: License declaration", help="The license attached to this package"),
    arg("--destination-directory", type=Path, default=Path(), help="Directory where to create the package directory"),
    arg(
        "--build-type", default="ament_cmake", choices=("cmake", "ament_cmake", "ament_python"),
        help="The build type to process the package with",
    ),
    arg("--dependencies", nargs="+", default=[], help="list of dependencies"),
    arg("--maintainer-email", help="email address of the maintainer"),
    arg("--maintainer-name", help="name of the maintainer"),
    arg("--node-name", type=_name, help="name of the empty executable"),
)  # fmt: skip
def create(args: Namespace) -> str | None:
    """Write the files, and print each of them."""
    if args.build_type != "ament_python":
        return "Deck's ros2 makes packages in Python only: add --build-type ament_python"
    if args.node_name == args.package_name:
        # Its file would hide the package of the same name.
        args.node_name += "_node"
        print(f"[WARNING] node name can not be equal to the package name: it is called '{args.node_name}'")
    args.maintainer_name = args.maintainer_name or getpass.getuser()
    args.maintainer_email = args.maintainer_email or f"{getpass.getuser()}@todo.todo"
    folder = args.destination_directory / args.package_name
    if folder.exists():
        return f"\nAborted!\nThe directory already exists: {folder}"
    print(f"going to create a new package\npackage name: {args.package_name}\nbuild type: {args.build_type}")
    try:
        for place, content in _files(args):
            (folder / place).parent.mkdir(parents=True, exist_ok=True)
            print(f"creating ./{args.package_name}/{place}")
            (folder / place).write_text(content, encoding="utf-8")
    except OSError as error:
        return f"{error.filename}: {error.strerror}"
    return None


def _files(args: Namespace) -> Iterator[tuple[str, str]]:
    """Yield path and content of each file, as colcon and ament want them."""
    name, node = args.package_name, args.node_name or ""
    depends = "".join(f"  <depend>{escape(each)}</depend>\n" for each in dict.fromkeys(args.dependencies))
    yield (
        "package.xml",
        _MANIFEST.format(
            name=name,
            description=escape(args.description),
            email=quoteattr(args.maintainer_email),
            maintainer=escape(args.maintainer_name),
            license=escape(args.license),
            depends=f"{depends}\n" if depends else "",
        ),
    )
    entry = f"            '{node} = {name}.{node}:main',\n" if node else ""
    yield "setup.py", _SETUP.format(**{**vars(args), "entry": entry})
    yield "setup.cfg", CONFIG.format(name=name)
    yield f"resource/{name}", ""
    yield f"{name}/__init__.py", ""
    for tool in ("copyright", "flake8", "pep257"):
        yield f"test/test_{tool}.py", _TEST.format(tool=tool)
    if node:
        yield f"{name}/{node}.py", _NODE.format(name=name)


_MANIFEST = """\
<?xml version="1.0"?>
<?xml-model href="http://download.ros.org/schema/package_format3.xsd" schematypens="http://www.w3.org/2001/XMLSchema"?>
<package format="3">
  <name>{name}</name>
  <version>0.0.0</version>
  <description>{description}</description>
  <maintainer email={email}>{maintainer}</maintainer>
  <license>{license}</license>

{depends}  <test_depend>ament_copyright</test_depend>
  <test_depend>ament_flake8</test_depend>
  <test_depend>ament_pep257</test_depend>
  <test_depend>python3-pytest</test_depend>

  <export>
    <build_type>ament_python</build_type>
  </export>
</package>
"""
_SETUP = """\
from setuptools import find_packages, setup

package_name = {package_name!r}

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
    maintainer={maintainer_name!r},
    maintainer_email={maintainer_email!r},
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
    assert main(argv=['.', 'test']) == 0, 'Found errors'
"""

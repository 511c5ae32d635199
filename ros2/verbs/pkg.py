"""`ros2 pkg`: the packages that are installed, and a new one of nodes in Python, ready for `colcon build`."""

from __future__ import annotations

import getpass
import re
from argparse import ArgumentTypeError
from pathlib import Path
from typing import TYPE_CHECKING

from ros2 import package_files
from ros2.packages import NoPackageError, executables, packages, prefix_of
from ros2.verb import arg, flag, verb

if TYPE_CHECKING:
    from argparse import Namespace

NO_LICENSE = "TODO: License declaration"
LICENSES = (
    "Apache-2.0", "BSL-1.0", "BSD-2.0", "BSD-2-Clause", "BSD-3-Clause", "GPL-3.0-only",
    "LGPL-2.1-only", "LGPL-3.0-only", "MIT", "MIT-0",
)  # fmt: skip
BUILD_TYPES = ("cmake", "ament_cmake", "ament_python")
NAMED = arg("package_name", help="The package name")


@verb("pkg list", "Output a list of available packages")
def list_packages(_args: Namespace) -> None:
    print("".join(f"{name}\n" for name in sorted(packages())), end="")


@verb(
    "pkg prefix", "Output the prefix path of a package", NAMED,
    flag("--share", help="Show share directory for the package prefix"),
)  # fmt: skip
def prefix_path(args: Namespace) -> str | None:
    try:
        prefix = prefix_of(args.package_name)
    except NoPackageError:
        return "Package not found"
    print(prefix / "share" / args.package_name if args.share else prefix)
    return None


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
    arg(
        "--package-format", "--package_format", choices=("2", "3"), default="3", help="The package.xml format.",
    ),
    arg("--description", default="TODO: Package description", help="The description given in the package.xml"),
    arg("--license", default=NO_LICENSE, help="The license attached to this package"),
    arg(
        "--destination-directory", type=Path, default=Path(), help="Directory where to create the package directory",
    ),
    arg(
        "--build-type", default="ament_cmake", choices=BUILD_TYPES,
        help="The build type to process the package with",
    ),
    arg("--dependencies", nargs="+", default=[], help="list of dependencies"),
    arg("--maintainer-email", default="", help="email address of the maintainer"),
    arg("--maintainer-name", default="", help="name of the maintainer"),
    arg("--node-name", type=_name, help="name of the empty executable"),
    arg("--library-name", help="name of the empty library"),
)  # fmt: skip
def create(args: Namespace) -> int | str | None:
    """Write the files, and print each of them."""
    if args.build_type != "ament_python":
        return "Deck's ros2 makes packages in Python only: add --build-type ament_python"
    if args.library_name:
        return "a library is for C++ packages, which Deck's ros2 does not make"
    if args.node_name == args.package_name:
        # Its file would hide the package of the same name.
        args.node_name += "_node"
        print(f"[WARNING] node name can not be equal to the package name: it is called '{args.node_name}'")
    folder = args.destination_directory / args.package_name
    if folder.exists():
        return f"\nAborted!\nThe directory already exists: {folder}"
    package = package_files.Package(
        name=args.package_name,
        package_format=int(args.package_format),
        description=args.description,
        license=args.license,
        maintainer=args.maintainer_name or getpass.getuser(),
        email=args.maintainer_email or f"{getpass.getuser()}@todo.todo",
        dependencies=tuple(dict.fromkeys(args.dependencies)),
        node=args.node_name or "",
    )
    _say(package, args.destination_directory.resolve())
    return _write(package, folder)


def _say(package: package_files.Package, place: Path) -> None:
    print("going to create a new package")
    for key, value in (
        ("package name", package.name),
        ("destination directory", place),
        ("package format", package.package_format),
        ("version", "0.0.0"),
        ("description", package.description),
        ("maintainer", [f"{package.maintainer} <{package.email}>"]),
        ("licenses", [package.license]),
        ("build type", "ament_python"),
        ("dependencies", list(package.dependencies)),
    ):
        print(f"{key}: {value}")
    if package.node:
        print(f"node_name: {package.node}")


def _write(package: package_files.Package, folder: Path) -> str | None:
    shown = f"./{package.name}"
    made: set[str] = set()
    try:
        for place, content in package_files.files(package).items():
            inner = Path(place).parent
            for part in [*reversed(inner.parents), inner]:
                path = shown if part == Path() else f"{shown}/{part}"
                if path not in made:
                    made.add(path)
                    (folder / part).mkdir(parents=True)
                    print(f"creating folder {path}")
            print(f"creating {shown}/{place}")
            (folder / place).write_text(content, encoding="utf-8")
    except OSError as error:
        return f"{error.filename}: {error.strerror}"
    if package.license not in LICENSES:
        print(
            f"\n[WARNING]: Unknown license '{package.license}'.  This has been set in the "
            "package.xml, but no LICENSE file has been created.\n"
            "It is recommended to use one of the ament license identifiers:"
        )
        print("\n".join(LICENSES))
    return None

"""`ros2 pkg xml`: the manifest of a package, or a tag of it."""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.etree import ElementTree as ET

from ros2.packages import NoPackageError, prefix_of

if TYPE_CHECKING:
    from argparse import ArgumentParser, Namespace

SUMMARY = "Output the XML of the package manifest or a specific tag"


def arguments(parser: ArgumentParser) -> None:
    parser.add_argument("package_name", help="The package name")
    parser.add_argument("-t", "--tag", help="The XML tag to output, e.g. 'version'")


def main(args: Namespace) -> str | None:
    try:
        file = prefix_of(args.package_name) / "share" / args.package_name / "package.xml"
        text = file.read_text(encoding="utf-8")
        root = ET.fromstring(text)
    except (NoPackageError, FileNotFoundError):
        return "Package not found"
    except (OSError, UnicodeDecodeError, ET.ParseError) as error:
        return f"The manifest of '{args.package_name}' cannot be read: {error}"
    if args.tag is None:
        print(text, end="" if text.endswith("\n") else "\n")
        return None
    found = root.findall(args.tag)
    if not found:
        return f"No tag '{args.tag}' found"
    for element in found:
        print("".join(element.itertext()))
    return None

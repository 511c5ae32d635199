"""`ros2 service call`: a request to a service, and its answer."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

from ros2 import naming, options
from ros2.filling import filled, read
from ros2.joining import SPIN_S, joined

if TYPE_CHECKING:
    import argparse

SUMMARY = "Call a service"
WORTH_SAYING_S = 1.0
"""A service that is found sooner has been there: there is no daemon that knew it before."""


def arguments(parser: argparse.ArgumentParser) -> None:
    options.of_node(parser)
    options.answers(parser)
    add = parser.add_argument
    add("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')")
    add("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')")
    values = parser.add_mutually_exclusive_group()
    values.add_argument(
        "values",
        nargs="?",
        default="{}",
        help="Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}'), "
        "otherwise the service request will be published with default values",
    )
    values.add_argument("--stdin", action="store_true", help="Read values from standard input")
    add("-r", "--rate", metavar="N", type=float, help="Repeat the call at a specific rate in Hz")


def main(args: argparse.Namespace) -> int | str | None:
    """Call it once, or again and again."""
    if args.rate is not None and args.rate <= 0:
        raise RuntimeError("rate must be greater than zero")
    kind = naming.service_class(args.service_type)
    values = read(sys.stdin.read() if args.stdin else args.values)
    if values is None:
        return "The passed value needs to be a dictionary in YAML format"
    draft = filled(kind.Request, values)
    with joined(args) as me:
        client = me.node.create_client(kind, args.service_name)
        if not client.wait_for_service(timeout_sec=WORTH_SAYING_S):
            print("waiting for service to become available...", flush=True)
            while not client.wait_for_service(timeout_sec=SPIN_S):
                pass
        while True:
            request = draft.dated()
            print(f"requester: making request: {request!r}\n", flush=True)
            asked = time.monotonic()
            future = client.call_async(request)
            me.finish(future, args.service_name, is_there=client.service_is_ready)
            if future.result() is None:
                raise RuntimeError(f"Exception while calling service: {future.exception()!r}")
            print(f"response:\n{future.result()!r}\n", flush=True)
            if args.rate is None:
                return None
            time.sleep(max(0.0, asked + 1 / args.rate - time.monotonic()))

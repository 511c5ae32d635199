"""`ros2 service`: lists, types and calls."""

from __future__ import annotations

import sys
import time
from functools import partial
from typing import TYPE_CHECKING

from ros2 import naming, options, rows
from ros2.filling import filled, read
from ros2.joining import SPIN_S, joined
from ros2.verb import arg, either, flag, verb

if TYPE_CHECKING:
    import argparse

WORTH_SAYING_S = 1.0
"""A service that is found sooner has been there: there is no daemon that knew it before."""
HIDDEN = options.hidden("services")

verb(
    "service list", "Output a list of available services", options.of_graph,
    flag("-t", "--show-types", help="Additionally show the service type"),
    flag("-c", "--count-services", dest="count", help="Only display the number of services discovered"), HIDDEN,
)(partial(rows.listed, "service"))  # fmt: skip
verb(
    "service find", "Output a list of available services of a given type", options.of_graph,
    arg("type", metavar="service_type", help="Name of the ROS service type to filter for"),
    flag("-c", "--count-services", dest="count", help="Only display the number found"), HIDDEN,
)(partial(rows.found, "service"))  # fmt: skip
verb(
    "service type", "Output a service's type", options.of_graph,
    arg("name", metavar="service_name", help="Name of the ROS service to get type (e.g. '/x')"), HIDDEN,
)(partial(rows.types, "service"))  # fmt: skip


@verb(
    "service call", "Call a service", options.of_node, options.answers,
    arg("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')"),
    arg("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')"),
    either(
        arg(
            "values", nargs="?", default="{}",
            help="Values to fill the service request with in YAML format (e.g. '{a: 1, b: 2}'), "
            "otherwise the service request will be published with default values",
        ),
        flag("--stdin", help="Read values from standard input"),
    ),
    arg("-r", "--rate", metavar="N", type=float, help="Repeat the call at a specific rate in Hz"),
)  # fmt: skip
def call(args: argparse.Namespace) -> int | str | None:
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

"""`ros2 service`: lists, types and calls."""

from __future__ import annotations

import time
from functools import partial
from typing import TYPE_CHECKING

from ros2 import naming
from ros2.joining import SPIN_S, joined
from ros2.messages import filled, load, read
from ros2.verb import ANSWERS, OF_GRAPH, TYPES, arg, flag, hidden, positive_float, verb

if TYPE_CHECKING:
    import argparse

WORTH_SAYING_S = 1.0
"""A service that is found sooner has been there: there is no daemon that knew it before."""

verb(
    "service list", "Output a list of available services", OF_GRAPH, TYPES,
    flag("-c", "--count-services", dest="count", help="Only display the number of services discovered"),
    hidden("services"),
)(partial(naming.list_all, "service"))  # fmt: skip
verb(
    "service type", "Output a service's type", OF_GRAPH,
    arg("name", metavar="service_name", help="Name of the ROS service to get type (e.g. '/x')"),
)(partial(naming.print_types, "service"))  # fmt: skip


@verb(
    "service call", "Call a service", OF_GRAPH, ANSWERS,
    arg("service_name", help="Name of the ROS service to call to (e.g. '/add_two_ints')"),
    arg("service_type", help="Type of the ROS service (e.g. 'std_srvs/srv/Empty')"),
    arg("values", nargs="?", default="{}", help="Values to fill the request with in YAML (e.g. '{a: 1, b: 2}')"),
    arg("-r", "--rate", metavar="N", type=positive_float, help="Repeat the call at a specific rate in Hz"),
)  # fmt: skip
def call(args: argparse.Namespace) -> None:
    """Call it once, or again and again."""
    kind = load(args.service_type, "srv")
    draft = filled(kind.Request, read(args.values))
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
            response = me.answer(client.call_async(request), args.service_name, client.service_is_ready)
            print(f"response:\n{response!r}\n", flush=True)
            if args.rate is None:
                return
            time.sleep(max(0.0, asked + 1 / args.rate - time.monotonic()))

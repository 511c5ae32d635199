"""Exchanging a node's program, with the same name, parameters, remaps and needs."""

from __future__ import annotations

import dataclasses
import sys

from launcher import node_program
from launcher.faults import CHECK_FIELDS
from launcher.supervisor.plan import NodePlan

_ROS_ARGS = "--ros-args"


def exchanged(plan: NodePlan, program: str) -> NodePlan:
    """Return the plan with a file, absolute, or a module of Deck in its program's place."""
    ros_args = _ros_args(plan)
    own = "/" in program
    env = {name: value for name, value in plan.env.items() if name != CHECK_FIELDS}
    return dataclasses.replace(
        plan,
        command=f"./{program.rpartition('/')[2]}" if own else program,
        argv=(sys.executable, "-u", node_program.__file__, program, *ros_args),
        module=(program, *ros_args) if plan.module else (),
        env={CHECK_FIELDS: "1", **plan.env} if own else env,
        file=program if own else "",
        ours=node_program.is_ours(program),
    )


def _ros_args(plan: NodePlan) -> tuple[str, ...]:
    given = plan.argv[plan.argv.index(_ROS_ARGS) + 1 :] if _ROS_ARGS in plan.argv else ()
    name = f"__node:={plan.name}"
    return (_ROS_ARGS, *(() if name in given else ("-r", name)), *given)

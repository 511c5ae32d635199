"""The mock robot as a process, and parameters of running nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import SetParameters

from tests.ros.node_process import NodeProcess

if TYPE_CHECKING:
    from pathlib import Path

    from tests.ros.peer import Peer


def mock_robot(domain: int, folder: Path, **params: object) -> NodeProcess:
    """Start the robot that is not there, with its devices in a folder."""
    return NodeProcess("nodes.mock_robot", domain, params={"folder": folder, **params})


def set_parameter(peer: Peer, node: str, name: str, value: str | float) -> None:
    """Set a parameter of a running node, which must take it."""
    if isinstance(value, str):
        carried = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=value)
    else:
        carried = ParameterValue(type=ParameterType.PARAMETER_DOUBLE, double_value=value)
    request = SetParameters.Request(parameters=[Parameter(name=name, value=carried)])
    (result,) = peer.ask(f"/{node}/set_parameters", SetParameters, request).results
    assert result.successful, result.reason

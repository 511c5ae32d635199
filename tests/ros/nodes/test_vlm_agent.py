"""The vision agent: pictures go to a real server, words and boxes come back, none is queued."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import pytest
from diagnostic_msgs.msg import DiagnosticArray
from std_msgs.msg import String

from tests.model_server import KEY, ModelServer, obeys
from tests.model_settings import write_settings
from tests.ros.node_process import NodeProcess
from tests.ros.peer import Peer
from tests.waiting import wait_until

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path


pytestmark = pytest.mark.nightly

BOX = {"left": 0.1, "top": 0.2, "right": 0.5, "bottom": 0.9}
SEEN = json.dumps({"description": "A red cup.", "things": [{"label": "cup", "box": BOX}]})


@pytest.fixture
def camera(ros_domain: int) -> Iterator[NodeProcess]:
    camera = NodeProcess("nodes.mock_camera", ros_domain)
    yield camera
    camera.close()


def pictures(server: ModelServer) -> list[str]:
    contents = [each.request["messages"][1]["content"] for each in server.exchanges]
    return [parts[0]["image_url"]["url"] for parts in contents if isinstance(parts, list)]


@pytest.mark.usefixtures("camera")
def test_a_picture_becomes_words_and_boxes(ros_domain: int, model_folder: Path) -> None:
    with ModelServer(obeys(SEEN)) as server, Peer(ros_domain) as peer:
        write_settings(model_folder, server.url, vision_model="m-sees")
        described = peer.hear("/vlm/description", String)
        detected = peer.hear("/vlm/detections", String)
        states = peer.hear("/brain_state", DiagnosticArray)
        agent = NodeProcess("nodes.vlm_agent", ros_domain, params={"period": 0.3})
        try:
            wait_until(lambda: described and detected and states, "a description")
            assert described[0].data == "A red cup."
            report = json.loads(detected[0].data)
            assert report == {"width": 640, "height": 480, "things": [{"label": "cup", "box": BOX}]}
            assert pictures(server)[0].startswith("data:image/jpeg;base64,/9j/")
            assert {each.request["model"] for each in server.exchanges} == {"m-sees"}
            agent.wait_for_words(f"go to m-sees at {server.url}", "m-sees sees: A red cup.")
            assert states[-1].status[0].name == "vlm_agent"
            assert KEY not in agent.output
        finally:
            agent.close()

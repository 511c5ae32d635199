"""Has a model with vision look through the camera, now and then.

Each `period` the newest picture goes to the model of the user's settings (`vision_model`, else
`model`), as a JPEG. Its words come on /vlm/description, and what stands out on /vlm/detections, as
JSON: `{"width", "height", "things": [{"label", "box"}]}`, where a box is `{"left", "top", "right",
"bottom"}` in shares of the picture, or null. While an answer is awaited pictures are passed over:
none is ever queued. What that takes is published on /brain_state.
"""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

from sensor_msgs.msg import Image
from std_msgs.msg import String

from brain.faults import ModelError
from brain.prompt import prompt_file, read_prompt
from nodes.parts.node import DEPTH, Number, Text
from nodes.parts.pictures import PictureTaker, jpeg_of
from nodes.parts.runner import run
from nodes.thinking.model import AskedModel, BrainState
from robot.topics import VLM_DESCRIPTION, VLM_DETECTIONS
from text.i18n import N_

if TYPE_CHECKING:
    from brain.ladder import Ladder
    from brain.looking import PictureSeen
    from brain.thinking import Thought

_STARTED = N_("Pictures from {topic} go to {model} at {url}")
_NO_MODEL = N_("No picture goes anywhere: {problem}")
_SEES = N_("{model} sees: {description}")
_FAILED = N_("No description: {problem}")
_SAY_EVERY_S = 30.0


class VlmAgent(PictureTaker):
    """Takes the newest picture, and asks about one at a time."""

    NAME = "vlm_agent"
    period = Number(5.0, "Time between two looks", low=0.1, high=3600.0, unit="s")
    prompt = Text("", "File with the system prompt; empty: Deck's own", may_be_empty=True)

    def __init__(self) -> None:
        super().__init__()
        self._description = self.create_publisher(String, VLM_DESCRIPTION, DEPTH)
        self._detections = self.create_publisher(String, VLM_DETECTIONS, DEPTH)
        self._problem: ModelError | None = None
        self._model = self._made()
        self._state = BrainState(self, self._model)

    def before_end(self) -> None:
        if self._model is not None:
            self._model.close()

    def _made(self) -> AskedModel | None:
        try:
            model = AskedModel(self, lambda settings: settings.vision_model or settings.model)
        except ModelError as error:
            self._problem = error
            self.say.warn(_NO_MODEL, problem=error.words)
            return None
        url = model.settings.base_url
        self.say.info(_STARTED, topic=self.topic, model=model.name, url=url)
        return model

    @property
    def is_ready(self) -> bool:
        if self._problem is not None:
            self.say.warn(_NO_MODEL, every_s=_SAY_EVERY_S, problem=self._problem.words)
        return self._model is not None and not self._model.busy

    def send(self, picture: Image) -> None:
        jpeg = jpeg_of(picture, self.quality)
        self._state.thinks()
        assert self._model is not None
        self._model.ask(
            lambda ladder: self._question(ladder, jpeg),
            lambda thought: self._tell(thought, picture.width, picture.height),
            self._fail,
        )

    async def _question(self, ladder: Ladder, jpeg: bytes) -> Thought[PictureSeen]:
        from brain.looking import look

        prompt = read_prompt(prompt_file(self.prompt, "vlm", self.say.language))
        return await look(ladder, prompt, jpeg)

    def _tell(self, thought: Thought[PictureSeen], width: int, height: int) -> None:
        seen, usage = thought.value, thought.usages[-1]
        self._state.answered(usage)
        self.say.info(_SEES, model=usage.model, description=seen.description)
        self._description.publish(String(data=seen.description))
        things = [thing.model_dump() for thing in seen.things]
        report = {"width": width, "height": height, "things": things}
        self._detections.publish(String(data=json.dumps(report, ensure_ascii=False)))

    def _fail(self, error: ModelError) -> None:
        self._state.failed(error)
        self.say.warn(_FAILED, problem=error.words)


if __name__ == "__main__":
    raise SystemExit(run(VlmAgent))

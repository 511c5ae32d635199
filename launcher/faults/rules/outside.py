"""What comes from outside of the program: files, devices, and texts that are read."""

from __future__ import annotations

import ast
import errno
import sys

from launcher.faults.failure import UNKNOWN, Failure
from text.sentences import Words, say


def files(failure: Failure) -> Words | None:
    """A file does not exist, or cannot be accessed."""
    error = failure.error
    name = getattr(error, "filename", None)
    within = failure.inner.file if failure.inner is not None else ""
    if isinstance(error, FileNotFoundError) and name and "subprocess" in within:
        return _program(str(name))
    if isinstance(error, FileNotFoundError) and name:
        return say(
            "There is no file {name}. A name without a slash in front is looked for in the folder"
            " that the program was started in, not beside its file: Path(__file__).parent / …",
            name=str(name),
        )
    if isinstance(error, IsADirectoryError) and name:
        return say("{name} is a folder, not a file.", name=str(name))
    if isinstance(error, PermissionError) and name:
        return say(
            "{name} may not be opened: whose is it? For a device, is the user in its group (dialout, video, audio)?",
            name=str(name),
        )
    if isinstance(error, ConnectionRefusedError):
        return say("Nobody listens there: is the server running, and is the port right?")
    if isinstance(error, EOFError):
        return say("A node has no keyboard: input() gets nothing. Take a parameter, or a topic that is published to.")
    return None


def _program(name: str) -> Words:
    """Say that there is no program of this name."""
    if " " in name:
        return say("A program and its arguments are a list: {parts}.", parts=str(name.split()))
    return say("There is no program {name} here: is it installed?", name=name)


def device(failure: Failure) -> Words | None:
    """A serial port is not there, or is another's."""
    error = failure.error
    if type(error).__name__ != "SerialException":
        return None
    call = failure.first(ast.Call)
    port = failure.value(call.args[0]) if call is not None and call.args else UNKNOWN
    if not isinstance(port, str):
        return None
    number = getattr(error, "errno", None)
    if port.upper().startswith("COM") and sys.platform != "win32":
        return say("{port} is a name of Windows: here a serial port is /dev/ttyUSB0 or /dev/ttyACM0.", port=port)
    if number == errno.ENOENT:
        return say("{port} is not there: is the device plugged in?", port=port)
    if number == errno.EACCES:
        return say("{port} may not be opened: is the user in the group dialout?", port=port)
    if number == errno.EBUSY:
        return say("{port} is in use by another program.", port=port)
    return None


def texts(failure: Failure) -> Words | None:
    """Bytes that are no text, text that is no JSON, JSON that does not fit."""
    error = failure.error
    kind = type(error).__name__
    if isinstance(error, UnicodeDecodeError):
        return say('The bytes are not UTF-8: decode("utf-8", errors="replace").')
    if isinstance(error, UnicodeEncodeError):
        return say('The text has letters that {encoding} has not: encode("utf-8").', encoding=error.encoding)
    if kind == "JSONDecodeError":
        document = str(getattr(error, "doc", ""))
        if not document.strip():
            return say("The text is empty, which is not JSON: catch the exception, and move nothing.")
        if document.lstrip().startswith(("{'", "['")):
            return say("JSON has double quotes, and this has single ones: json.dumps writes it right.")
        return say("The text is not JSON: catch the exception, and move nothing.")
    if type(error).__module__.startswith("yaml.") and hasattr(error, "problem_mark"):
        mark = error.problem_mark
        return say(
            "The text is not YAML: look at line {line} of it. Blocks are indented with blanks, not"
            " tabs, and brackets are closed.",
            line=mark.line + 1 if mark is not None else 1,
        )
    if kind == "ValidationError" and type(error).__module__.startswith("pydantic"):
        return say("The JSON does not fit the model: catch ValidationError, and move nothing.")
    return None


RULES = (device, files, texts)

"""What rclpy, tf2 and OpenCV say by an exception of their own."""

from __future__ import annotations

import ast
import gc

from launcher.faults.failure import Failure, is_from, name_of, shown
from launcher.faults.rules.own_attributes import taken_name
from text.i18n import N_
from text.sentences import Words, say
from text.suggestions import nearest

UNHEARD = N_(
    "A Buffer hears nothing by itself: self.listener = TransformListener(self.buffer, self) in __init__ fills it."
)
SENTENCES = {
    "NotInitializedException": N_("rclpy.init() has to be called before a node is made."),
    "ExternalShutdownException": N_("The node was asked to end: catch ExternalShutdownException around rclpy.spin."),
    "KeyboardInterrupt": N_("Ctrl-C is the exception KeyboardInterrupt: catch it around rclpy.spin."),
    "ParameterAlreadyDeclaredException": N_("The parameter is declared twice."),
    "InvalidParameterTypeException": N_(
        "The parameter has another type than its default: 1.0 is a double, 1 an integer."
    ),
    "InvalidParameterValueException": N_(
        "The value was refused, by the range in the parameter's descriptor or by your own callback."
    ),
    "ParameterImmutableException": N_(
        "The parameter is read_only: its value is given at the start, and not changed."
    ),
    "InvalidHandle": N_("This was destroyed already: it is used after destroy_node()."),
    "InvalidQoSProfileException": N_("A QoSProfile needs its depth: QoSProfile(depth=10)."),
    "UnknownROSArgsError": N_("ROS does not know the arguments that stand after --ros-args."),
    "ConnectivityException": N_(
        "Both frames are there, and nothing joins them: a transform between them is missing, or is"
        " published under another name."
    ),
    "InvalidArgumentException": N_("The name of a frame is empty, or begins with a slash: base_link, without one."),
    "NoTypeSupportImportedException": N_("The type's package is not built for Python: is it built and sourced?"),
}
"""By the name of the exception's class."""
_PACKAGES = ("rclpy", "tf2_py", "tf2_ros", "builtins")


def named(failure: Failure) -> Words | None:
    """An exception that has only one meaning."""
    for kind in type(failure.error).__mro__:
        if kind.__name__ in SENTENCES and kind.__module__.partition(".")[0] in _PACKAGES:
            return say(SENTENCES[kind.__name__])
    return None


def undeclared(failure: Failure) -> Words | None:
    """A parameter that was not declared, or that has no value."""
    kind = type(failure.error).__name__
    name = _parameter(failure)
    if kind == "ParameterNotDeclaredException":
        node = failure.named("self")
        known = list(node._parameters) if is_from(node, "rclpy", "Node") else []  # noqa: SLF001
        meant = nearest(name.strip("'"), known)
        if meant:
            return say("No parameter {name} is declared; did you mean {meant!r}?", name=name, meant=meant)
        return say(
            "Declare the parameter before you read it, in __init__: self.declare_parameter({name}, 0.0).", name=name
        )
    if kind == "ParameterUninitializedException":
        return say(
            "The parameter {name} was declared by its type alone, and nobody has given it a value:"
            " declare it with a default, self.declare_parameter({name}, …), or set it in the"
            " profile.",
            name=name,
        )
    return None


def _parameter(failure: Failure) -> str:
    """Return the name of the parameter that the learner's own line asks for, in quotes."""
    calls = [each for call in failure.all(ast.Call) for each in ast.walk(call)]
    for call in calls:
        if isinstance(call, ast.Call) and call.args:
            name = failure.value(call.args[0])
            if isinstance(name, str):
                return repr(name)
    first = failure.first(ast.Call)
    if first is not None and first.args and not isinstance(first.args[0], (ast.List, ast.Tuple)):
        return shown(first.args[0])
    return "name"


def bad_name(failure: Failure) -> Words | None:
    """The name of a node, a topic or a service is not allowed."""
    error = failure.error
    kinds = {each.__name__ for each in type(error).__mro__}
    if "NameValidationException" not in kinds:
        return None
    values = failure.inner.values if failure.inner is not None else {}
    at = values.get("invalid_index", 0)
    name = next((each for each in values.values() if isinstance(each, str) and each != values.get("error_msg")), "")
    sign = name[at] if isinstance(at, int) and at < len(name) else ""
    if "InvalidNodeNameException" in kinds:
        return say(
            "The name of a node has letters, digits and _, and begins with no digit; {name!r} has"
            " {sign!r} at {place}.",
            name=name,
            sign=sign,
            place=at + 1,
        )
    if "InvalidNamespaceException" in kinds:
        return say("A namespace has letters, digits, _ and /: {name!r}.", name=name)
    return say(
        "The name of a topic or service has letters, digits, _ and /, and no digit after a /;"
        " {name!r} has {sign!r} at {place}.",
        name=name,
        sign=sign,
        place=at + 1,
    )


def started_twice(failure: Failure) -> Words | None:
    """`rclpy.init` or `rclpy.shutdown` was called twice."""
    called = {level.function for level in failure.levels if level.is_in("rclpy")}
    kind = type(failure.error).__name__
    if isinstance(failure.error, RuntimeError) and "init" in called and kind == "RuntimeError":
        return say("rclpy.init() was called a second time: once, in main, is enough.")
    if "shutdown" in called and kind in ("RCLError", "RuntimeError"):
        return say("rclpy has been shut down already: write rclpy.try_shutdown(), not rclpy.shutdown().")
    return None


def spun_twice(failure: Failure) -> Words | None:
    """An executor was spun while it was spun already: within a callback, or by another thread."""
    if not is_spun_twice(failure):
        return None
    if any(level.function == "handler" and level.is_in("rclpy") for level in failure.levels):
        return say(
            "The node is spun within its own callback: spin once, in main, and have answers"
            " called back, future.add_done_callback(self.on_answer)."
        )
    return say(
        "Several threads spin one executor, which only one can, and rclpy.spin(node) takes the same"
        " for all nodes: give them all to one, executor = MultiThreadedExecutor(),"
        " executor.add_node(node), and executor.spin() once, in main."
    )


def is_spun_twice(failure: Failure) -> bool:
    """Whether an executor says that somebody else is at work in it."""
    inner = failure.inner
    if inner is None or inner.function != "wait_for_ready_callbacks" or not inner.is_in("rclpy"):
        return False
    said = str(failure.error)
    return (isinstance(failure.error, ValueError) and "generator already executing" in said) or (
        isinstance(failure.error, TypeError) and "not an iterator" in said
    )


def spun(failure: Failure) -> Words | None:
    """`rclpy.spin` was given a class, or nothing that is a node."""
    level = next(
        (each for each in failure.levels if each.is_in("rclpy") and each.function in ("spin", "spin_once")), None
    )
    if level is None or "node" not in level.values:
        return None
    node = level.values["node"]
    if isinstance(node, type):
        return say("rclpy.spin was given a class: make a node of it first, node = {name}().", name=node.__name__)
    if not is_from(node, "rclpy", "Node"):
        return say("rclpy.spin was given {type}, not a node.", type=name_of(type(node)))
    return None


def two_types(failure: Failure) -> Words | None:
    """A topic was used with two types in one node, or a name of rclpy's own was taken."""
    level = next(
        (each for each in failure.below("rclpy") if each.function in ("create_publisher", "create_subscription")),
        None,
    )
    if level is None or type(failure.error).__name__ not in ("RCLError", "RuntimeError"):
        return None
    node, topic = level.values["self"], level.values.get("final_topic", level.values.get("topic"))
    others = {each.msg_type.__name__ for each in (*node.publishers, *node.subscriptions) if each.topic_name == topic}
    if not others:
        return None
    return say(
        "This node uses {topic} with the type {other} already: a topic has one type.",
        topic=topic,
        other=", ".join(others),
    )


def severity(failure: Failure) -> Words | None:
    """One line of the program logs with two severities."""
    inner = failure.inner
    if inner is None or not isinstance(failure.error, ValueError) or not inner.is_in("rclpy", "rcutils_logger"):
        return None
    return say(
        "A line of a program logs always alike, with one severity, one name, one filter: write two"
        " lines, an info() in the one branch and an error() in the other."
    )


def looked_up(failure: Failure) -> Words | None:
    """A frame is not known, or not at that time."""
    kind = type(failure.error).__name__
    level = next(
        (
            each
            for each in failure.levels
            if each.function.startswith(("lookup_transform", "transform")) and each.is_in("tf2_ros")
        ),
        None,
    )
    if kind == "LookupException":
        return _unheard(failure) or say(
            "Nobody has published this frame yet: in the first seconds that is normal, so catch"
            " TransformException and try again; later, look at its name in Frames."
        )
    if kind == "ExtrapolationException":
        time = level.values.get("time") if level is not None else None
        newest = getattr(time, "nanoseconds", 1) == 0
        if not newest:
            return say(
                "The transform of this very moment is still under way: ask for the newest one,"
                " rclpy.time.Time(), or wait for it, timeout=Duration(seconds=0.1) in a thread of"
                " its own. Catch TransformException."
            )
        return say("The frames have no time in common: one of them is published no more.")
    return None


def _unheard(failure: Failure) -> Words | None:
    """Say that nobody fills the buffer that was asked; None if somebody does."""
    asked = (level.values.get("self") for level in failure.levels if level.is_in("tf2_ros"))
    buffer = next((each for each in asked if type(each).__name__ == "Buffer"), None)
    if buffer is None or buffer.all_frames_as_yaml().strip(" {}[]\n"):
        return None
    # A node keeps the listener that it was given to, whoever has made it.
    for each in gc.get_objects():
        if type(each).__name__ == "TransformListener" and vars(each).get("buffer") is buffer:
            return None
    return say(UNHEARD)


def asynchronous(failure: Failure) -> Words | None:
    """`asyncio` was awaited, which rclpy does not run."""
    if not isinstance(failure.error, RuntimeError) or "/asyncio/" not in (
        failure.inner.file if failure.inner is not None else ""
    ):
        return None
    return say(
        "rclpy does not run asyncio: in its callbacks await goes with futures of rclpy, such as"
        " client.call_async(request); for a pause take a timer."
    )


def other_names(failure: Failure) -> Words | None:
    """A name of rclpy's own was taken, and rclpy fails by it."""
    if isinstance(failure.error, (AttributeError, TypeError)) and not failure.is_own:
        return taken_name(failure)
    return None


RULES = (
    spun, named, undeclared, bad_name, started_twice, spun_twice, two_types, severity, looked_up,
    asynchronous,
)  # fmt: skip
LAST = (other_names,)

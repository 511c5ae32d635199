"""`deck model serve FILE`: a language model on this machine, for Deck to ask."""

from __future__ import annotations

import asyncio
import contextlib
import os
import shlex
import socket
import sys
from argparse import Namespace
from collections.abc import Coroutine
from ipaddress import ip_address
from pathlib import Path
from typing import TypeVar
from urllib.parse import urlsplit

from brain.faults import ModelError
from brain.serving.model_file import ModelFile, ServingError, examine
from brain.serving.server import Order
from brain.serving.service import ServedAnswer, Service, installed, require_port
from brain.settings import load, settings_path
from cli.commands import Parser, command
from cli.options import add_language, between, port
from launcher.processes.ending import ENDING
from launcher.processes.interrupts import run
from launcher.profile.defaults import shown
from text.i18n import _, localized
from text.output import BOLD, RED, YELLOW, Paint, say_error, write
from text.sentences import say

T = TypeVar("T")
EVERYWHERE = ("0.0.0.0", "::")
CONTEXT = 8192
"""Tokens at once where nobody says how many: a picture and a long conversation fit in."""


def _model_options(parser: Parser) -> None:
    actions = parser.add_subparsers(dest="action", metavar=_("ACTION"))
    about = _("serve a model from a file on this machine, by the protocol of OpenAI")
    serve = actions.add_parser("serve", help=about, description=about, allow_abbrev=False)
    _add_serve(serve)
    add_language(serve)


def _add_serve(parser: Parser) -> None:
    parser.add_argument("file", metavar=_("FILE"), help=_("the model, a GGUF file"))
    parser.add_argument(
        "--mmproj",
        dest="eyes",
        metavar=_("FILE"),
        help=_("for a model that sees: the file beside it that turns pictures into tokens"),
    )
    parser.add_argument(
        "--port", metavar="N", type=port, default=8080, help=_("8080 by default; 0: any that is free")
    )
    parser.add_argument(
        "--host",
        metavar=_("ADDRESS"),
        default="127.0.0.1",
        help=_("for whom: by default this machine only; 0.0.0.0: everybody on the network"),
    )
    parser.add_argument(
        "--context",
        metavar="N",
        type=between(256, 1 << 24),
        help=_(
            "tokens at once, question and answer together: 8192 by default, or what the model was"
            " trained for if that is less"
        ),
    )
    parser.add_argument(
        "--threads", metavar="N", type=between(1, 512), help=_("by default one less than there are cores")
    )
    parser.add_argument("--verbose", action="store_true", help=_("show the log of llama.cpp"))
    parser.epilog = _(
        "Runs until Ctrl-C, with llama.cpp inside. Exit code: 0 when it was ended, 1 if llama.cpp"
        " broke off, 2 if it could not start."
    )


@command("model", _model_options)
def model_command(options: Namespace) -> int:
    """Serve a model until interrupted; without an action, show the help."""
    if options.action is None:
        from cli.commands import parser_of

        parser_of("model").print_help()
        return 0
    try:
        return run(_serve(_order(options), verbose=options.verbose))
    except ServingError as error:
        say_error(localized(error.words))
        return 2


def _order(options: Namespace) -> Order:
    """Return what to serve and how; raises a ServingError."""
    file = examine(Path(options.file).expanduser())
    eyes = options.eyes and examine(Path(options.eyes).expanduser())
    if not installed():
        python = shlex.quote(sys.executable)
        raise ServingError(
            say("llama.cpp is not installed: {python} -m pip install 'xllamacpp>=2026.10'", python=python)
        )
    require_port(options.host, options.port)
    _warn_of_little_memory(file, file.size + (eyes.size if eyes else 0))
    return Order(
        path=str(file.path),
        name=file.name,
        host=options.host,
        port=options.port,
        context=_context(file, options.context),
        # One core is left to the robot.
        threads=options.threads or max(1, (os.cpu_count() or 2) - 1),
        eyes=str(eyes.path) if eyes else "",
    )


def _context(file: ModelFile, wanted: int | None) -> int:
    trained = file.trained_context
    if wanted is not None and trained is not None and wanted > trained:
        words = say("{name} was trained for {trained} tokens at once: --context {trained} at most", name=file.name,
                    trained=trained)  # fmt: skip
        raise ServingError(words)
    return wanted or min(CONTEXT, trained or CONTEXT)


def _warn_of_little_memory(file: ModelFile, size: int) -> None:
    import psutil

    free = psutil.virtual_memory().available
    if size > free:
        words = _("{file} takes {size:.1f} GB of memory, and {free:.1f} GB are free: it will be slow, or be killed")
        words = words.format(file=shown(file.path), size=size / 1e9, free=free / 1e9)
        say_error(Paint(sys.stderr)(words, YELLOW))


async def _serve(order: Order, *, verbose: bool) -> int:
    over = asyncio.Event()
    for number in ENDING:
        asyncio.get_running_loop().add_signal_handler(number, over.set)

    def tell(answered: ServedAnswer) -> None:
        try:
            write(_told(answered))
        except OSError:
            # Whoever read this is gone.
            over.set()

    write(_("loading {file} ...").format(file=shown(Path(order.path))))
    async with Service(order, tell, say_error if verbose else lambda _line: None) as service:
        address = await _unless(over, service.ready())
        if address is None:
            return 0
        _introduce(order, address)
        fault = await _unless(over, service.end())
    if fault is None:
        return 0
    say_error(localized(fault.words))
    return 1


async def _unless(over: asyncio.Event, awaited: Coroutine[None, None, T]) -> T | None:
    """Return what is awaited, None if it is over before."""
    task, end = asyncio.ensure_future(awaited), asyncio.ensure_future(over.wait())
    try:
        await asyncio.wait((task, end), return_when=asyncio.FIRST_COMPLETED)
        return None if over.is_set() else task.result()
    finally:
        for each in (task, end):
            each.cancel()
        await asyncio.gather(task, end, return_exceptions=True)


def _introduce(order: Order, address: str) -> None:
    """Say where the model is to be found, and how Deck comes to use it."""
    paint = Paint(sys.stdout)
    port = urlsplit(address).port
    host = socket.gethostname() if order.host in EVERYWHERE else urlsplit(address).hostname
    url = f"http://[{host}]:{port}/v1" if ":" in str(host) else f"http://{host}:{port}/v1"
    words = _("{name} is served at {url}, {context} tokens at once; Ctrl-C ends it")
    write(paint(words.format(name=order.name, url=url, context=order.context), BOLD))
    if not _loopback(order.host):
        words = _("WARNING: whoever reaches {host} on the network can use it, and there is no password")
        say_error(Paint(sys.stderr)(words.format(host=host), RED))
    if _in_use(url, order.name):
        write(_("Deck's settings already name it"))
        return
    write(_("for Deck to ask it, write into {path}:").format(path=settings_path()))
    write(f'  base_url: {url}\n  model: "{order.name}"')
    write(_("or, for what is started in one terminal:"))
    write(f"  export DECK_LLM_BASE_URL={shlex.quote(url)} DECK_LLM_MODEL={order.name}")


def _loopback(host: str) -> bool:
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _in_use(url: str, name: str) -> bool:
    with contextlib.suppress(ModelError):
        settings = load()
        return settings is not None and (settings.base_url, settings.model) == (url, name)
    return False


def _told(answered: ServedAnswer) -> str:
    words = _("answered in {took:.1f} s: {read} tokens read, {written} written, {rate:.0f} a second")
    return words.format(took=answered.took_s, read=answered.read, written=answered.written, rate=answered.rate)

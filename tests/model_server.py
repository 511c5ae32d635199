"""A small HTTP server that answers as a server of language models does, or as a broken one.

It speaks OpenAI's protocol of streamed chat completions on a real socket; what it answers is the
test's to say.
"""

from __future__ import annotations

import contextlib
import json
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, Any

from brain.ladder import NAME, Rung

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from typing_extensions import Self

    Script = Callable[["Exchange"], None]

KEY = "sk-test-2f81c4"
"""A key as a test's settings have it: it must never be seen again."""


class Exchange:
    """One request and the means to answer it."""

    def __init__(self, handler: BaseHTTPRequestHandler, request: Any) -> None:
        self.request = request
        """The JSON of the request."""
        self.path = handler.path
        self.port = handler.client_address[1]
        """The other end's: what comes by one connection has the same."""
        self.headers = {name.lower(): value for name, value in handler.headers.items()}
        self._handler = handler

    # ---------------------------------------------------------------- whole answers

    def says(self, text: str, *, usage: tuple[int, int] | None = (120, 40)) -> None:
        """Stream a text, in pieces, to its proper end."""
        self.begins()
        for at in range(0, len(text), 7):
            self.piece({"content": text[at : at + 7]})
        self.ends(usage=usage)

    def calls(self, arguments: str) -> None:
        self.begins()
        call = {"index": 0, "id": "call-1", "type": "function"}
        self.piece({"tool_calls": [{**call, "function": {"name": NAME, "arguments": arguments}}]})
        self.ends("tool_calls")

    def fails(self, status: int, body: str = "", kind: str = "application/json", **headers: str) -> None:
        """Answer with a status and a body; `Retry_After` becomes Retry-After."""
        data = (body or json.dumps({"error": {"message": "no"}})).encode()
        self._handler.send_response(status)
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        length = {"Content-Type": kind, "Content-Length": str(len(data))}
        for name, value in {**length, **named}.items():
            self._handler.send_header(name, value)
        self._handler.end_headers()
        self._handler.wfile.write(data)

    # ---------------------------------------------------------------- a stream, step by step

    def begins(self, packed_by: str = "") -> None:
        self._handler.send_response(200)
        self._handler.send_header("Content-Type", "text/event-stream")
        if packed_by:
            self._handler.send_header("Content-Encoding", packed_by)
        self._handler.send_header("Transfer-Encoding", "chunked")
        self._handler.end_headers()

    def piece(self, delta: Mapping[str, Any], finish: str | None = None) -> None:
        choice = {"index": 0, "delta": delta, "finish_reason": finish}
        self.event(json.dumps({**_CHUNK, "choices": [choice]}))

    def event(self, data: str) -> None:
        """Send a line of the stream, whatever is in it."""
        self.bytes(f"data: {data}\n\n".encode())

    def ends(self, finish: str = "stop", usage: tuple[int, int] | None = None) -> None:
        self.piece({}, finish)
        if usage is not None:
            counted = {"prompt_tokens": usage[0], "completion_tokens": usage[1]}
            total = {**counted, "total_tokens": sum(usage)}
            self.event(json.dumps({**_CHUNK, "choices": [], "usage": total}))
        self.event("[DONE]")
        self._handler.wfile.write(b"0\r\n\r\n")

    def bytes(self, data: bytes) -> None:
        """Send a piece of the stream's body, whatever is in it."""
        self._handler.wfile.write(f"{len(data):x}\r\n".encode() + data + b"\r\n")
        self._handler.wfile.flush()


_CHUNK = {"id": "c-1", "object": "chat.completion.chunk", "created": 0, "model": "m"}


class ModelServer:
    """The server, in threads of the test's process; use it in a `with`."""

    def __init__(self, script: Script) -> None:
        self.script = script
        """Answers each request; a test may replace it at any time."""
        self.exchanges: list[Exchange] = []
        self.closing = threading.Event()
        """Set when the server ends: what a script waits for that never answers."""
        self._server = ThreadingHTTPServer(("127.0.0.1", 0), self._handler())
        self._server.daemon_threads = True
        self._thread = threading.Thread(target=self._server.serve_forever, args=(0.02,))

    @property
    def url(self) -> str:
        return f"http://127.0.0.1:{self._server.server_port}/v1"

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self.closing.set()
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()

    def _handler(self) -> type[BaseHTTPRequestHandler]:
        server = self

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"
            # As servers of models do: each piece leaves at once, not with the next one.
            disable_nagle_algorithm = True

            def do_POST(self) -> None:
                length = int(self.headers.get("Content-Length", 0))
                body = self.rfile.read(length)
                if len(body) < length:
                    # A question that was cancelled while it was being asked.
                    self.close_connection = True
                    return
                is_json = self.headers.get("Content-Type", "").startswith("application/json")
                exchange = Exchange(self, json.loads(body) if is_json else body)
                server.exchanges.append(exchange)
                try:
                    server.script(exchange)
                except OSError:
                    # The other end has hung up, as some tests want.
                    self.close_connection = True

            def handle(self) -> None:
                """Serve a connection, until the other end closes it in whatever way."""
                with contextlib.suppress(ConnectionResetError):
                    super().handle()

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002
                """Say nothing."""

        return Handler


def rung_of(request: Any) -> Rung | None:
    """Return the way in which a request asks for a form, None if it asks for none."""
    form = request.get("response_format", {})
    if form.get("type") == "json_schema":
        return Rung.STRICT
    return Rung.TOOL if request.get("tools") else None


def schema_of(request: Any) -> Any:
    """Return the JSON schema that a request asks for."""
    rung = rung_of(request)
    if rung is Rung.STRICT:
        return request["response_format"]["json_schema"]["schema"]
    return request["tools"][0]["function"]["parameters"]


def hangs_up(_: Exchange) -> None:
    """Close the connection without an answer: the script of a server that does."""
    raise OSError


def obeys(answer: str, rung: Rung = Rung.STRICT) -> Script:
    """Return the script of a server that obeys one way to ask, and answers others with words."""

    def script(exchange: Exchange) -> None:
        if rung_of(exchange.request) is not rung:
            exchange.says("As you like: here you are!")
            return
        properties = schema_of(exchange.request)["properties"]
        if "number" in properties:
            text = json.dumps({name: field["enum"][0] for name, field in properties.items()})
        else:
            text = answer
        (exchange.calls if rung is Rung.TOOL else exchange.says)(text)

    return script

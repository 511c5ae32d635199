"""The page of Rerun's web viewer, served to browsers without its ways out.

As Rerun serves it, the page asks a font server on the internet, and the viewer in it reports from
the browser how it is used, where nobody can switch that off. So it is fetched from Rerun on this
machine, and handed on with a policy under which a browser connects it to this machine only.
"""

from __future__ import annotations

import gzip
import re
import threading
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING, NamedTuple
from urllib.request import ProxyHandler, build_opener

from view.place import HERE

if TYPE_CHECKING:
    from typing_extensions import Self

    from view.place import Place

ELSEWHERE = re.compile(rb"<link\b[^>]*https?://[^>]*>")
"""Tags by which a page makes a browser connect before any policy is asked."""
PASSED_ON = ("Content-Type", "rerun-final-length")
FETCH_S = 60.0
PLAIN_BYTES = 1400
"""What fits into one packet is not compressed."""


class _Asset(NamedTuple):
    headers: dict[str, str]
    body: bytes


class ViewPage:
    """A server of the page at one port of this machine."""

    def __init__(self, place: Place, origin_port: int) -> None:
        """Serve what Rerun serves at `origin_port`."""
        assets = _Assets(origin_port)
        policy = policy_for(place.data_port)
        told = f"/?{place.query}"

        class Handler(BaseHTTPRequestHandler):
            protocol_version = "HTTP/1.1"

            def do_GET(self) -> None:
                self._answer(with_body=True)

            def do_HEAD(self) -> None:
                self._answer(with_body=False)

            def _answer(self, *, with_body: bool) -> None:
                if self.path == "/":
                    # So that the address can be said, and typed.
                    self.send_response(HTTPStatus.FOUND)
                    self.send_header("Location", told)
                    self.send_header("Content-Length", "0")
                    self.end_headers()
                    return
                asset = assets.get(self.path.partition("?")[0])
                self.send_response(HTTPStatus.OK if asset else HTTPStatus.NOT_FOUND)
                body = asset.body if asset else b""
                for name, value in (asset.headers if asset else {}).items():
                    self.send_header(name, value)
                self.send_header("Content-Length", str(len(body)))
                self.send_header("Content-Security-Policy", policy)
                self.send_header("Referrer-Policy", "no-referrer")
                self.send_header("X-Content-Type-Options", "nosniff")
                self.send_header("X-DNS-Prefetch-Control", "off")
                self.end_headers()
                if with_body:
                    self.wfile.write(body)

            def log_message(self, format: str, *args: object) -> None:  # noqa: A002
                del format, args

        self._server = _PageServer((HERE, place.page_port), Handler)
        self._thread = threading.Thread(target=self._server.serve_forever, name="deck-page", daemon=True)
        self._thread.start()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Serve nobody any more."""
        self._server.shutdown()
        self._server.server_close()
        self._thread.join()


class _PageServer(ThreadingHTTPServer):
    daemon_threads = True

    def handle_error(self, request: object, client_address: object) -> None:
        """Say nothing of a browser that has gone: standard error may be a screen."""
        del request, client_address


def policy_for(data_port: int) -> str:
    """Return what the page may do in a browser: run as it is, and read from this machine.

    Source: Content Security Policy Level 3.
    """
    sources = " ".join(f"http://{name}:{data_port}" for name in (HERE, "localhost"))
    return "; ".join(
        (
            "default-src 'none'",
            "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' blob:",
            "style-src 'self' 'unsafe-inline'",
            "img-src 'self' data: blob:",
            "font-src 'self' data:",
            "worker-src 'self' blob:",
            f"connect-src 'self' {sources}",
            "base-uri 'none'",
            "form-action 'none'",
            "frame-ancestors 'none'",
        )
    )


class _Assets:
    """What Rerun serves, each fetched once and kept compressed: over SSH that is a third."""

    def __init__(self, origin_port: int) -> None:
        self._origin = f"http://{HERE}:{origin_port}"
        # No proxy of the environment: it is this machine.
        self._opener = build_opener(ProxyHandler({}))
        self._kept: dict[str, _Asset | None] = {}
        self._lock = threading.Lock()

    def get(self, path: str) -> _Asset | None:
        """Return what is at a path, None for nothing."""
        with self._lock:
            if path not in self._kept:
                self._kept[path] = self._fetch(path)
            return self._kept[path]

    def _fetch(self, path: str) -> _Asset | None:
        try:
            with self._opener.open(f"{self._origin}{path}", timeout=FETCH_S) as answer:
                body = answer.read()
                headers = {name: value for name in PASSED_ON if (value := answer.headers.get(name))}
        except OSError:
            return None
        if headers.get("Content-Type", "").startswith("text/html"):
            body = ELSEWHERE.sub(b"", body)
            headers.pop("rerun-final-length", None)
        if len(body) > PLAIN_BYTES:
            headers["Content-Encoding"] = "gzip"
            body = gzip.compress(body, compresslevel=1)
        return _Asset(headers, body)

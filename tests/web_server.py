"""A small server on the loopback address that answers ranges of bytes of a folder, or misbehaves as it is told."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import urlsplit


class Server(ThreadingHTTPServer):
    """Serves a folder; counts what it sent."""

    daemon_threads = True

    def __init__(self, folder: Path) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.folder = folder
        self.requests: list[tuple[str, int, int]] = []  #: Path, first and last byte of each request
        self.sent = 0  #: Bytes of all bodies
        self.whole = False  #: Answer 200 with all bytes
        self.cut = 0  #: How many of the next replies end in the middle
        self.fail = 0  #: How many of the next replies are 503
        self.delay = 0.0  #: Seconds before each reply
        self.pace = 0.0  #: Seconds between two pieces of 16 kB
        self.total = None  #: The size that replies name, in place of the true one
        self.extra = b""  #: Bytes that bodies have in addition
        self.version = "1"  #: The ETag
        self.redirect = ""  #: Where all requests are led
        self.token = ""  #: The only value of the header Authorization that is let in
        self.missing_from = None  #: Ranges from this byte on are not found
        self.by_query = lambda path, query: path  # noqa: ARG005 - the file that a path with a query means
        self.seen: list[str] = []  #: Values of the header Authorization

    def address(self, name: str) -> str:
        """Return the address of a file."""
        return f"http://127.0.0.1:{self.server_address[1]}/{name}"


class _Handler(BaseHTTPRequestHandler):
    server: Server

    def log_message(self, *_: object) -> None:
        """Print nothing."""

    def do_GET(self) -> None:
        server, parts = self.server, urlsplit(self.path)
        path = server.by_query(parts.path.lstrip("/"), parts.query)
        file = server.folder / path
        first, last = (int(one) for one in self.headers["Range"].removeprefix("bytes=").split("-"))
        server.requests.append((path, first, last))
        server.seen.append(self.headers.get("Authorization", ""))
        time.sleep(server.delay)
        status = self._refusal(file, first)
        if status:
            self.send_response(status)
            self.send_header("Location", server.redirect)
            self.send_header("Content-Length", "0")
            self.end_headers()
            return
        content = file.read_bytes()
        body = (content if server.whole else content[first : last + 1]) + server.extra
        self.send_response(200 if server.whole else 206)
        self.send_header("Content-Length", str(len(body)))
        self.send_header("ETag", server.version)
        self.send_header("Content-Range", f"bytes {first}-{first + len(body) - 1}/{server.total or len(content)}")
        self.end_headers()
        if server.cut:
            server.cut, body = server.cut - 1, body[: len(body) // 2]
        self._send(body)

    def _refusal(self, file: Path, first: int) -> int:
        server = self.server
        if server.fail:
            server.fail -= 1
            return 503
        if server.redirect:
            return 302
        if server.token and self.headers.get("Authorization") != server.token:
            return 401
        is_missing = server.missing_from is not None and first >= server.missing_from
        return 404 if is_missing or not file.is_file() else 0

    def _send(self, body: bytes) -> None:
        for start in range(0, len(body), 2**14):
            time.sleep(self.server.pace)
            piece = body[start : start + 2**14]
            try:
                self.wfile.write(piece)
            except OSError:
                return
            self.server.sent += len(piece)


@contextmanager
def serving(folder: Path) -> Iterator[Server]:
    """Serve a folder while the block runs."""
    with Server(folder) as server:
        thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.05}, daemon=True)
        thread.start()
        try:
            yield server
        finally:
            server.shutdown()
            thread.join()

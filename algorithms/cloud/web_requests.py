"""One request for a range of bytes: by the standard library, or by the means of the program around it."""

import ssl
from dataclasses import dataclass
from http.client import HTTPException
from typing import Callable, Protocol
from urllib.error import URLError
from urllib.request import HTTPHandler, HTTPSHandler, OpenerDirector, ProxyHandler, Request

# Seconds after which a server that sends nothing is taken to have failed; the request is then repeated.
TIMEOUT = 10.0


class NoAnswerError(Exception):
    """A request failed in a way that another try may mend; the message says how."""


@dataclass(frozen=True)
class Reply:
    """The answer of a server; redirections are not followed."""

    status: int  #: HTTP status
    data: bytes = b""  #: The body of status 200 and 206, and at most one byte more than was asked for
    content_range: str = ""  #: "bytes 0-99/2000", of status 200 see :func:`range_of_whole`
    location: str = ""  #: Where a redirection leads
    version: str = ""  #: ETag, or the time of the last change; "" if the server names neither


def range_of_whole(length: str, data: bytes) -> str:
    """Return the range of a whole file that a server sent in place of one; without its length, what came counts."""
    size = int(length) if length.isdecimal() else len(data)
    return f"bytes 0-{size - 1}/{size}"


class Transport(Protocol):
    """Sends requests."""

    def get(self, url: str, first: int, last: int, login: str, is_stopped: Callable[[], bool]) -> Reply:
        """Ask for the bytes from ``first`` to ``last``, both included; raise :class:`NoAnswerError` if it fails.

        ``login`` names how the user is known to the server, "" for none.
        """

    def wait(self) -> None:
        """Do what the program must go on with while its other threads wait for replies."""


class _StandardLibrary:
    """Requests by the standard library, with the proxies of the environment."""

    def __init__(self) -> None:
        self._opener = OpenerDirector()
        # Without the handlers of redirections, files and FTP.
        for handler in (ProxyHandler(), HTTPHandler(), HTTPSHandler(context=ssl.create_default_context())):
            self._opener.add_handler(handler)

    def get(self, url: str, first: int, last: int, login: str, is_stopped: Callable[[], bool]) -> Reply:
        if login:
            raise ValueError(
                f"The authentication configuration {login!r} can be used in QGIS only, and not by other processes; "
                "run in QGIS, and a survey with PROCESSES=1."
            )
        request = Request(url, headers={"Range": f"bytes={first}-{last}", "Accept-Encoding": "identity"})
        try:
            with self._opener.open(request, timeout=TIMEOUT) as answer:
                heads = answer.headers
                data = self._body(answer, last - first + 2, is_stopped) if answer.status in (200, 206) else b""
        except (OSError, URLError, HTTPException) as error:
            raise NoAnswerError(str(getattr(error, "reason", error)) or type(error).__name__) from None
        version = heads.get("ETag") or heads.get("Last-Modified") or ""
        whole = range_of_whole(heads.get("Content-Length", ""), data) if answer.status == 200 else ""
        return Reply(answer.status, data, whole or heads.get("Content-Range", ""), heads.get("Location", ""), version)

    def _body(self, answer, most: int, is_stopped: Callable[[], bool]) -> bytes:
        found = bytearray()
        while len(found) < most and not is_stopped() and (piece := answer.read1(most - len(found))):
            found += piece
        return bytes(found)

    def wait(self) -> None:
        """Do nothing."""


_transport: list[Transport] = [_StandardLibrary()]


def use_transport(transport: Transport) -> Transport:
    """Have all requests sent by ``transport`` from now on; return the one before it."""
    before, _transport[0] = _transport[0], transport
    return before


def transport() -> Transport:
    """Return the transport of all requests."""
    return _transport[0]

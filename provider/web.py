"""Point clouds on the web, read as QGIS reads layers: through its proxy, certificates and authentication."""

from collections.abc import Iterable
from pathlib import Path
from typing import Callable, NamedTuple, Optional, cast

import numpy as np
from qgis.core import QgsApplication, QgsDataSourceUri, QgsNetworkAccessManager
from qgis.PyQt.QtCore import QCoreApplication, QEventLoop, QTimer, QUrl
from qgis.PyQt.QtNetwork import QNetworkReply, QNetworkRequest

from ..algorithms.cloud.files import sizes_within
from ..algorithms.cloud.web_addresses import is_address
from ..algorithms.cloud.web_file import WebFile
from ..algorithms.cloud.web_requests import TIMEOUT, NoAnswerError, Reply, range_of_whole, use_transport
from ..algorithms.stage import Monitor
from ..algorithms.threads import BETWEEN_LOOKS
from .options import WEB_LIMIT
from .qgis_crs import is_main_thread


class QgisTransport:
    """Requests by the network manager of QGIS, which each thread has its own of."""

    def get(self, url: str, first: int, last: int, login: str, is_stopped: Callable[[], bool]) -> Reply:
        """Ask for the bytes from ``first`` to ``last``; redirections are not followed."""
        request = QNetworkRequest(QUrl(url))
        request.setRawHeader(b"Range", f"bytes={first}-{last}".encode())
        # Qt would unpack what a server packs, whatever its size.
        request.setRawHeader(b"Accept-Encoding", b"identity")
        attributes = QNetworkRequest.Attribute
        request.setAttribute(attributes.RedirectPolicyAttribute, QNetworkRequest.RedirectPolicy.ManualRedirectPolicy)
        request.setAttribute(attributes.CacheLoadControlAttribute, QNetworkRequest.CacheLoadControl.AlwaysNetwork)
        request.setAttribute(attributes.CacheSaveControlAttribute, False)
        request.setTransferTimeout(round(1000 * TIMEOUT))
        if login and not QgsApplication.authManager().updateNetworkRequest(request, login):
            raise ValueError(f"There is no authentication configuration {login!r} in QGIS; check its name.")
        # Before the request: its timers need the event dispatcher of the thread, which a loop makes.
        loop = QEventLoop()
        reply = QgsNetworkAccessManager.instance().get(request)
        try:
            return _finished(reply, loop, last - first + 2, is_stopped)
        finally:
            reply.deleteLater()

    def wait(self) -> None:
        """Let the main thread answer what other threads ask it: for passwords, say."""
        if is_main_thread():
            QCoreApplication.processEvents(QEventLoop.ProcessEventsFlag.ExcludeUserInputEvents)


def _finished(reply: QNetworkReply, loop: QEventLoop, most: int, is_stopped: Callable[[], bool]) -> Reply:
    """Wait for the end of a reply, which is ended where it has more bytes than asked for; return it."""
    timer, kept = QTimer(), b""
    timer.start(round(1000 * BETWEEN_LOOKS))
    # No signals: Python keeps what is connected to them, and takes it for the one of a later reply at the same address.
    while not reply.isFinished():
        loop.processEvents(QEventLoop.ProcessEventsFlag.WaitForMoreEvents)
        if reply.bytesAvailable() >= most:
            # Nothing can be read of a reply that was ended.
            kept = kept or bytes(reply.read(most))
        if kept or is_stopped() or _status(reply) not in (0, 200, 206):
            reply.abort()
    timer.stop()
    status = _status(reply)
    if status == 0:
        raise NoAnswerError(reply.errorString())
    data = kept or (bytes(reply.read(most)) if status in (200, 206) and reply.isOpen() else b"")
    location = reply.header(QNetworkRequest.KnownHeaders.LocationHeader)
    version = _head(reply, b"ETag") or _head(reply, b"Last-Modified")
    whole = range_of_whole(_head(reply, b"Content-Length"), data) if status == 200 else ""
    found = whole or _head(reply, b"Content-Range")
    return Reply(status, data, found, location.toString() if location else "", version)


def _status(reply: QNetworkReply) -> int:
    """Return the HTTP status of a reply, 0 before there is one."""
    return int(reply.attribute(QNetworkRequest.Attribute.HttpStatusCodeAttribute) or 0)


def _head(reply: QNetworkReply, name: bytes) -> str:
    return bytes(reply.rawHeader(name)).decode("latin-1")


use_transport(QgisTransport())


def web_file(source: str) -> Optional[Path]:
    """Return the file on the web that a text or the source of a layer names, None if it names none.

    With an authentication configuration of QGIS it is ``authcfg=… url=https://…``.

    Raises
    ------
    ValueError
        If the address is none that can be read.
    """
    if is_address(source):
        return cast(Path, WebFile(source))
    if "url=" not in source:
        return None
    uri = QgsDataSourceUri(source)
    if "&" in source and not is_address(uri.param("url")):
        uri.setEncodedUri(source)
    return cast(Path, WebFile(uri.param("url"), uri.authConfigId())) if is_address(uri.param("url")) else None


class Size(NamedTuple):
    """How much is read from the web."""

    name: str  #: Of the file, or of the first one of several
    host: str
    points: int
    bytes: int

    def __str__(self) -> str:
        return f"{self.bytes / 1e6:,.1f} MB with {self.points:,} points"


def web_size(paths: Iterable[Path], box: Optional[np.ndarray], spacing: Optional[np.ndarray] = None) -> Optional[Size]:
    """Return the size of the parts of clouds that a box and a spacing need from the web, None if none is there.

    It costs a few requests, also of a large cloud with an octree. Files in folders are left out.
    """
    found = [one for path in paths if not path.is_dir() for one in sizes_within(path, box, spacing)]
    if not found:
        return None
    first = cast(WebFile, found[0][0])
    others = f" and {len(found) - 1} more files" if len(found) > 1 else ""
    return Size(first.name + others, first.host, *(sum(size[i] for _, size in found) for i in (0, 1)))


# Bytes that the user has agreed to in this session, beyond the limit.
_agreed = [0]


def agree_to(size: Size) -> None:
    """Let runs of this session read as much as this at once, for which the user was asked."""
    _agreed[0] = max(size.bytes, _agreed[0])


def is_over_limit(size: Size) -> bool:
    """Whether it is more than the user has set as limit, or agreed to.

    Raises
    ------
    ValueError
        If the limit is no number.
    """
    text = WEB_LIMIT.value
    if not (text.isdigit() and int(text)):
        raise ValueError(f"'{WEB_LIMIT.title}' in the options of Processing must be a whole number, got {text!r}.")
    return size.bytes > max(int(text) * 1e6, _agreed[0])


def check_sizes(paths: Iterable[Path], box: Optional[np.ndarray], spacing: Optional[np.ndarray] = None) -> None:
    """Refuse to read more from the web than the user has set as limit.

    Raises
    ------
    ValueError
        If it is more; it says how much, and asks for an extent.
    """
    size = web_size(paths, box, spacing)
    if size is not None and is_over_limit(size):
        which = "the whole cloud" if box is None else "what lies within the extent"
        raise ValueError(
            f"{size.name} is on the web, and {which} is {size}, more than the {WEB_LIMIT.value} MB that are read at "
            f"once; choose {'an' if box is None else 'a smaller'} extent or a wider spacing, or set "
            f"'{WEB_LIMIT.title}' in the options of Processing."
        )


def log_size(paths: Iterable[Path], box: Optional[np.ndarray], spacing: Optional[np.ndarray], monitor: Monitor) -> None:
    """Tell how many bytes and points are read from the web, before they are."""
    size = web_size(paths, box, spacing)
    if size is not None:
        monitor.inform(f"{size.name}: {size} are read from {size.host}.")

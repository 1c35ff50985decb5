"""Addresses on the web: those that may be read, their display, and redirections."""

import ipaddress
import re
import socket
from collections.abc import Iterable
from functools import lru_cache
from typing import Any
from urllib.parse import SplitResult, urljoin, urlsplit

from .printable import shown

_BEGINNING = re.compile(r"https?:/", re.IGNORECASE)
# Hosts that files on this computer may name point clouds of, by the user's own choice.
_allowed: set[str] = set()


def is_address(text: Any) -> bool:
    """Whether a text is meant as an address on the web."""
    return isinstance(text, str) and bool(_BEGINNING.match(text))


def split_address(address: str) -> SplitResult:
    """Return the parts of an address that can be read.

    Raises
    ------
    ValueError
        If the text is no address, or has a user name or password in it, which logs and histories would keep.
    """
    try:
        parts = urlsplit(address)
        is_known = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:
        is_known = False
    if not is_known or not address.isascii() or not address.isprintable() or " " in address:
        name = re.sub("//.*@", "//…@", address)
        raise ValueError(f"{shown(name)!r} is no address on the web; give it as https://host/file.copc.laz.")
    if parts.username is not None or parts.password is not None:
        raise ValueError(
            f"The address at {parts.hostname} has a user name or password in it, which logs would keep; choose an "
            "authentication configuration of QGIS instead (authcfg=… url=https://…)."
        )
    return parts


def without_query(address: str) -> str:
    """Return an address as it is shown: without its query, which may be a key."""
    parts = urlsplit(address)
    return f"{parts.scheme}://{parts.netloc}{parts.path}"


def allow_hosts(hosts: Iterable[str]) -> None:
    """Have files on this computer name point clouds on these hosts, and on no others, from now on."""
    _allowed.clear()
    _allowed.update(host.lower() for host in hosts)


def is_allowed(address: str) -> bool:
    """Whether a file on this computer may name a point cloud at this address."""
    return split_address(address).hostname in _allowed


def same_server(one: str, other: str) -> bool:
    """Whether two addresses are of one server, which may know the user by one login."""
    return split_address(one)[:2] == split_address(other)[:2]


def redirected(address: str, location: str) -> str:
    """Return the address to which a redirection, or a name in what was read there, leads.

    Raises
    ------
    ValueError
        If the text is no address, or leads from a public address to one of this computer or its network.
    """
    leads = urljoin(address, location)
    try:
        host = split_address(leads).hostname
    except ValueError:
        raise ValueError(f"{without_query(address)} leads to {shown(location)!r}, which is not followed.") from None
    own = urlsplit(address).hostname
    if host != own and _is_private(str(host)) and not _is_private(str(own)):
        raise ValueError(
            f"{without_query(address)} leads to {host}, an address of this computer or its network, which is not "
            "followed; give the address itself if it is yours."
        )
    return leads


def _is_private(host: str) -> bool:
    """Whether a host has an address that is not public; where only a proxy knows its name, it is taken as public."""
    try:
        found = _addresses(host)
    except OSError:
        return False
    return any(not ipaddress.ip_address(one.partition("%")[0]).is_global for one in found)


@lru_cache(maxsize=64)
def _addresses(host: str) -> frozenset[str]:
    """Return the addresses of a host, which a catalog may name thousands of times; failures are not kept."""
    return frozenset(str(entry[4][0]) for entry in socket.getaddrinfo(host, None))

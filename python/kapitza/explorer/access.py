"""Who may use the explorer's server: hosts and origins that are its own, and tokens."""

import secrets
import threading
from urllib.parse import urlsplit

LOOPBACK = ("127.0.0.1", "localhost", "[::1]")
# Addresses and pages that are remembered; the oldest addresses go first, and pages that have asked least lately
UNUSED, PAGES = 16, 32


class WrongArgument(ValueError):
    """An argument that cannot be used; the text names it and says what can."""


def origin(text, option="--origin"):
    """An origin as browsers send it: scheme, host, and a port where it is not the scheme's own."""
    try:
        parts = urlsplit(text)
        bad = parts.scheme not in ("http", "https") or not parts.hostname or parts.path.strip(
            "/") or parts.query or "@" in parts.netloc
    except ValueError:
        bad = True
    if bad:
        raise WrongArgument(
            f"{option}: {text} is not an origin; write for example https://hub.example.org or http://machine:8888")
    return text.rstrip("/")


class Access:
    """`origins`: those allowed beside the server's own ("https://hub.example.org"). Every page trades the token of its
    address, which is good for once, for one of its own: what a browser's command line shows is worth nothing to those
    who read it later."""

    def __init__(self, origins=()):
        self.origins = tuple(origin.rstrip("/") for origin in origins)
        self._lock = threading.Lock()
        self._once, self._pages = [], []

    def knows(self, host, origin):
        """Whether a request names this server, by a loopback name or an allowed origin, and comes from a page of it.
        Ports are free: a forwarded port has another number here."""
        host = host or ""
        name = host.rsplit(":", 1)[0] if not host.endswith("]") else host
        own = f"http://{host}"
        if name not in LOOPBACK and not any(allowed.partition("://")[2] == host for allowed in self.origins):
            return False
        return origin is None or (origin == own and name in LOOPBACK) or origin in self.origins

    def new_address(self):
        """A token that serves once, for an address."""
        with self._lock:
            token = secrets.token_urlsafe(32)
            self._once = [*self._once, token][-UNUSED:]
            return token

    def trade(self, once):
        """A page's own token for that of its address; None where that has served, or never was one."""
        with self._lock:
            found = [token for token in self._once if _same(token, once)]
            if not found:
                return None
            self._once.remove(found[0])
            self._pages = [*self._pages, secrets.token_urlsafe(32)][-PAGES:]
            return self._pages[-1]

    def admits(self, token):
        """Whether that is a page's token."""
        with self._lock:
            known = [page for page in self._pages if _same(page, token)]
            if known:
                self._pages.remove(known[0])
                self._pages.append(known[0])
            return bool(known)


def _same(token, other):
    return isinstance(other, str) and secrets.compare_digest(token.encode(), other.encode(errors="replace"))

"""The explorer in a cell of a Jupyter notebook."""

import html
import os
import re

from kapitza.program import program, scene_error
from kapitza.scene import Scene, SceneLike

from .access import origin

LOCAL = ("http://localhost:*", "http://127.0.0.1:*")  # a policy's sources have no form for [::1]
_FRAME = re.compile(r"('self'|https?://[\w.\-*]+(:(\d+|\*))?|vscode-webview:)")


class Shown:
    """An explorer at work; shows its page where a notebook displays it. `explorer.close()` ends it, as the end of the
    kernel does."""

    def __init__(self, explorer, base, height):
        self._explorer, self._base, self._height = explorer, base, height
        explorer.serve()

    @property
    def port(self):
        """Of the server, on this machine."""
        return self._explorer.port

    def address(self):
        """An address of the page, good for one browser."""
        return self._explorer.new_address(self._base)

    def _repr_html_(self):
        return f'<iframe src="{html.escape(self.address())}" width="100%" height="{self._height}" style="border:0" ' \
               'allow="clipboard-write"></iframe>'

    def close(self):
        """Ends the server and its engines."""
        self._explorer.close()


def explore(scene: SceneLike, *, set=None, height=760, port=0, base=None, origins=(), frames=None):
    """Shows the explorer of a scene in a cell of a notebook.

    The returned object is shown by the cell; its method `close()` ends the explorer.

    :param scene: path of a scene or of a result, YAML text, or a mapping
    :param set: keys to change, such as `{"pendulum.m": 0.4}`
    :param height: height of the cell, CSS pixels
    :param port: port of the server on the kernel's machine; 0 = a free one
    :param base: address at which the browser reaches the server, with `{port}` in it; None =
        `http://127.0.0.1:{port}/`, or the server proxy of JupyterHub
    :param origins: origins of that address if it is on another machine, such as `["https://hub.example.org"]`
    :param frames: origins of pages that may contain the cell; None = this machine and `origins`
    """
    from .server import Explorer, Refused, Start  # with what draws: not for those who only import the package
    hub = os.environ.get("JUPYTERHUB_SERVICE_PREFIX")
    origins = [origin(text, "origins") for text in origins]
    if hub and base is None and not origins:
        raise ValueError('behind JupyterHub the browser\'s origin must be named: explore(scene, '
                         'origins=["https://hub.example.org"])')
    frames = ["'self'", *LOCAL, *origins] if frames is None else list(frames)
    if bad := [text for text in frames if not _FRAME.fullmatch(text)]:
        raise ValueError(f"frames: {bad[0]} is not an origin; write for example https://hub.example.org")
    given = Scene(scene, set)
    try:
        explorer = Explorer(Start(given.path, sets=given.sets[1::2]), program(), port, origins, frames)
    except Refused as error:
        raise scene_error(str(error), given) from error
    base = base or (f"{hub}proxy/{{port}}/" if hub else "http://127.0.0.1:{port}/")
    return Shown(explorer, base.format(port=explorer.port), height)

"""What a page may ask of the server itself: each answer takes the server and the request, and gives JSON."""

from pathlib import Path

from kapitza import style
from kapitza.units import written_frequency

from .atlas import maps
from .overlays import overlays, skeleton
from .stories import read, written


def page_folder():
    """Where the page is: in the package where it is installed, in a folder of its own in the sources."""
    places = [Path(__file__).resolve().parents[up] / "web" / "explorer" for up in (1, 3)]
    return next((place for place in places if place.is_dir()), places[-1])


def state(explorer, request):
    """What the page needs before its first frame."""
    pendulum = explorer.start.pendulum()
    return {"title": explorer.title, "pendulum": pendulum, "window": explorer.start.window(), "kinds": style.KINDS,
            "pivot_frequency": written_frequency(pendulum), "overlays": overlays(explorer.start.result)}


def scene(explorer, request):
    """The scene of a view."""
    return {"text": explorer.start.view(request)}


def link(explorer, request):
    """The token of another address."""
    return {"once": explorer.access.new_address()}


def stories(explorer, request):
    """The stories that come with the page; that of a text where there is one."""
    if "text" not in request:
        return {"stories": written(page_folder() / "stories")}
    return {"stories": [read(str(request["text"]), str(request.get("name", "the story")))]}


ANSWERS = {"state": state, "scene": scene, "link": link, "stories": stories}
RUNS = {"atlas": maps, "skeleton": skeleton}  # long requests: (kept runs, request) -> answers in parts

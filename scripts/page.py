"""The explorer as a folder of static files: page.py FOLDER. Its engine is the library (page_engine.py)."""

import gzip
import hashlib
import json
import re
import shutil
import sys
from pathlib import Path

import page_engine
from kapitza import style
from kapitza.explorer.scene import Start
from kapitza.explorer.stories import written
from kapitza.library import load
from kapitza.units import written_frequency

ROOT = Path(__file__).resolve().parents[1]
EXPLORER = ROOT / "web" / "explorer"
FIRST = "blackburn-fig12"  # the scene that is shown until another one is chosen
USED = ("kapitza_cycle", "kapitza_cycles", "kapitza_parameters", "kapitza_catalogue", "kapitza_frame_request",
        "kapitza_frame_part", "kapitza_chart_part", "kapitza_ending", "kapitza_endings")


def kind_of(ffi, kind):
    """How the page reads a member: letter and bytes of a number, or the name of a structure."""
    if kind.kind == "struct":
        return kind.cname
    if kind.kind == "pointer":
        return "p8"
    letter = {"c": "c", "f": "f", "d": "f", "u": "u"}.get(kind.cname[0], "i")
    return f"{letter}{ffi.sizeof(kind)}"


def layout():
    """Sizes of the library's structures, and places of their members: those of x86-64 are those of wasm64."""
    ffi, found = load().ffi, {}
    for name in USED:
        fields = {}
        for field, place in ffi.typeof(name).fields:
            array = place.type.kind == "array"
            kind = place.type.item if array else place.type
            fields[field] = [place.offset, kind_of(ffi, kind), place.type.length if array else None]
        found[name] = {"size": ffi.sizeof(name), "fields": fields}
    return found


def scene_row(path):
    """A scene as the page takes it; None of one without a pendulum that it can show."""
    start = Start(path)
    pendulum = start.pendulum()
    if not pendulum or "basin" not in start.tree:
        return None
    window = start.window()
    basin = {name: value for name, value in start.tree["basin"].items() if name == "start_phase"} | window
    return {"name": path.stem, "title": start.tree.get("title", path.stem), "pendulum": pendulum, "basin": basin,
            "window": window, "pivot_frequency": written_frequency(pendulum)}


def catalogue():
    """Scenes, stories, colours, places of members: what `kapitza view` tells its page."""
    rows = [row for path in sorted((ROOT / "scenes").glob("*.yaml")) if (row := scene_row(path))]
    rows.sort(key=lambda row: row["name"] != FIRST)
    return {"scenes": rows, "kinds": style.KINDS, "stories": written(EXPLORER / "stories"), "layout": layout()}


def build(folder):
    """Writes the page, and says what a visitor fetches."""
    folder.mkdir(parents=True, exist_ok=True)
    engines = page_engine.build()
    (folder / "page.json").write_text(json.dumps(catalogue(), separators=(",", ":")))
    for path in [*engines, *EXPLORER.glob("*.css"), *EXPLORER.glob("*.js"), ROOT / "web" / "page" / "offline.js"]:
        shutil.copy(path, folder)
    (folder / "served.js").unlink()
    text = (EXPLORER / "index.html").read_text()
    first = '<meta charset="utf-8" />'
    text = text.replace(first, f'{first}\n    <meta name="engine" content="tab" />', 1)
    (folder / "index.html").write_text(text)
    files = sorted(path for path in folder.iterdir() if path.name not in ("offline.js", "engine-plain.wasm"))
    version = hashlib.sha256(b"".join(path.read_bytes() for path in files)).hexdigest()[:16]
    offline = (folder / "offline.js").read_text()
    names = ["./", *(path.name for path in files)]
    offline = re.sub(r"^const FILES = .*$", f"const FILES = {json.dumps(names)};", offline, flags=re.M)
    (folder / "offline.js").write_text(offline.replace("VERSION", version, 1))
    size = sum(len(gzip.compress(path.read_bytes(), 9, mtime=0)) for path in files)
    print(f"page: {folder}: {len(files)} files, {size / 1e6:.2f} MB as a browser fetches them (gzip)")


if __name__ == "__main__":
    build(Path(sys.argv[1]))

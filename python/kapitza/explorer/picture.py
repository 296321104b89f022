"""Pictures (PNG) that the explorer's page saves: the scene of their view is a text in them."""

from kapitza.result import BadFile

SIGNATURE = b"\x89PNG\r\n\x1a\n"
SCENE = "kapitza scene"  # keyword of the text, as web/explorer/save.js has it


def scene_in(path):
    """The scene that a picture holds."""
    scene = _texts(path.read_bytes()).get(SCENE)
    if scene is None:
        raise BadFile(f"{path}: the picture holds no scene; pictures that the explorer saves as PNG hold theirs")
    return scene


def _texts(data):
    """The texts of chunks iTXt that are not compressed: {keyword: text}."""
    found, at = {}, len(SIGNATURE)
    while at + 12 <= len(data):
        length, kind = int.from_bytes(data[at:at + 4], "big"), data[at + 4:at + 8]
        parts = data[at + 8:at + 8 + length].split(b"\0", 5) if kind == b"iTXt" else []
        if len(parts) == 6 and parts[1] == parts[2] == b"":  # no compression: two bytes of 0 behind the keyword
            found[parts[0].decode("latin-1")] = parts[5].decode("utf-8", "replace")
        at += length + 12
    return found

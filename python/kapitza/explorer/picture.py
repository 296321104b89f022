"""Pictures (PNG) that the explorer's page saves: the scene of their view is a text in them."""

from kapitza.result import BadFile

SIGNATURE = b"\x89PNG\r\n\x1a\n"
SCENE = "kapitza scene"  # keyword of the text, as web/explorer/save.js has it


def scene_in(path):
    """The scene that a picture holds."""
    from PIL import Image  # the server of scenes does without it
    try:
        with Image.open(path, formats=["PNG"]) as picture:
            scene = picture.info.get(SCENE)  # texts stand before the pixels, which are not read
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError) as error:
        raise BadFile(f"{path}: damaged") from error
    if scene is None:
        raise BadFile(f"{path}: the picture holds no scene; pictures that the explorer saves as PNG hold theirs")
    return str(scene)

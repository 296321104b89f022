"""Kinds of motion, by which figures and the page have their colours (kapitza.style.KINDS)."""

# Codes of the variable `centre`.
DOWN, INVERTED, ROTATING = 0, 1, 2


def kind(period: int, winding: int, centre: int) -> str:
    """The kind of motion of an attractor: a key of kapitza.style.KINDS."""
    if period == 0 and winding == 0:
        return "chaotic"
    if centre == ROTATING:
        return f"{'rotation' if period > 0 else 'running'} {'+' if winding > 0 else '-'}"
    if centre == INVERTED:
        return {1: "inverted", 2: "flutter"}.get(period, "inverted nodding")
    if centre == DOWN:
        return "down" if period == 1 else "down nodding"
    return "other"

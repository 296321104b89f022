"""Where single starts end, for kapitza.where."""

import warnings
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from kapitza import units
from kapitza.library import load
from kapitza.live import endings_of
from kapitza.program import SceneError, scene_error, source
from kapitza.scene import Scene, SceneLike, texts

if TYPE_CHECKING:
    import pandas

MOST = 100_000  # starts of one call
COUNTS = ("period", "winding", "settling_time", "near_time", "turns")
UNDAMPED = ("pendulum: has no damping, so there are no attractors and no start gets a label; give damping, or ask for "
            "orbit or saddles")


def where(scene: SceneLike, theta: Any, velocity: Any, set: Mapping[str, Any] | None = None) -> "pandas.DataFrame":
    """Returns where starts end: a table with a row for each start.

    The columns are theta, velocity, attractor (id; -1 = not settled), name, period (0 = it never closes), winding,
    settling_time (drive periods after which the end is certain), decided, strobe_theta and strobe_velocity (lists),
    precision, error (rad), other_attractor, other_name, near_time (drive periods after which the angle stays within 1
    degree of the final motion), turns (net turns until an oscillation; missing for other ends) and mean_velocity. A
    value that does not exist is missing. For a scene in SI units there are also velocity_rad_per_s, settling_seconds,
    near_seconds and strobe_velocity_rad_per_s.

    :param scene: path of a scene file, YAML text, or a mapping
    :param theta: angles in rad from down, or texts such as "175 deg" and "pi/2"; a number or an array
    :param velocity: velocities in rad per drive radian, or, for a scene in SI units, texts such as "3 rad/s". The
        arrays are broadcast; at most 100,000 starts
    :param set: keys to change
    :raises SceneError: if the program refuses the scene or a start
    """
    import pandas
    asked = Scene(scene, set)
    angles, speeds = (np.ravel(values) for values in np.broadcast_arrays(_starts(theta), _starts(velocity)))
    if len(angles) > MOST:
        raise SceneError(f"{len(angles)} starts are too many (at most {MOST})")
    units.note_bare(angles)
    for text in (*angles, *speeds):
        if any(letter in str(text) for letter in ",\r\n"):
            raise SceneError(f"{str(text)!r} is not one number; give an array for several starts")
    try:
        rows, numbers = ends(*source(asked), list(angles), list(speeds))
    except SceneError as error:
        raise scene_error(str(error), asked) from None
    if not numbers["beta"] > 0:
        warnings.warn(UNDAMPED, stacklevel=2)
    columns = list(rows[0]) if rows else ["theta", "velocity", *COUNTS]
    return pandas.DataFrame(rows, columns=columns).astype(dict.fromkeys(COUNTS, "Int64"))


def _starts(values: Any) -> np.ndarray:
    """Numbers as texts that read back as the same numbers, and texts as they are; of any shape."""
    given = np.asarray(values, dtype=object)
    return np.vectorize(texts, otypes=[object])(given) if given.size else given


def ends(text: str | bytes, name: str, sets: Sequence[str], theta: Sequence[str],
         velocity: Sequence[str]) -> tuple[list[dict[str, Any]], dict[str, float]]:
    """A row for each start, and damping and pivot frequency of the pendulum."""
    library = load()
    (angles, _), (speeds, _), (scene, _) = kept = [library.texts(theta), library.texts(velocity),
                                                   library.scene(text, name, sets)]
    given = library.ffi.new("kapitza_endings **")
    library.call("kapitza_where_of", scene, len(theta), angles, speeds, given)
    del kept
    try:
        numbers = given[0].parameters
        return endings_of(library, given[0][0]), {"beta": numbers.beta, "pivot_frequency": numbers.pivot_frequency}
    finally:
        library.lib.kapitza_free(given[0])

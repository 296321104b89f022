"""Which share of labels changes if friction is partly quadratic: scripts/benchmark quadratic_drag [SIDE]

A rig has viscous and quadratic friction, theta'' + beta theta' + drag |theta'| theta' + (k - m cos t) sin theta = 0. A
scene has the viscous friction that loses as much energy in swings of 10 or 40 degrees (`Fit.scene`). Both are followed
from SIDE x SIDE starts by Runge-Kutta's method of fourth order, so that the only difference is the friction. Runs with
other steps and with 1 % more friction say how many labels change anyway.
"""

import sys

import numpy as np

# Name -> k, beta, m, largest velocity, drive periods that are followed.
RIGS = {"Fig. 12": (1 / 121, 1 / 55, 0.3, 2.0, 200),
        "20 cm, 50 Hz, 8 mm, Q = 18": (0.0004968, 0.0012383, 0.04, 0.05, 1500)}
DRAGS = (0.0005, 0.002, 0.01, 0.05)  # per rad; a steel rod of 20 cm with a weight of 30 g has some 0.002


def runge_kutta(pendulum, state, periods, steps):
    """The state, (angle, velocity) or arrays of them, after whole drive periods; angles are not wrapped.
    `drag`: of friction drag |v| v beside the viscous one."""
    k, beta, m, drag = (pendulum.get(name, 0) for name in ("k", "beta", "m", "drag"))
    theta, velocity = state
    h = 2 * np.pi / steps

    def slope(t, x, v):
        return v, -(beta + drag * np.abs(v)) * v - (k - m * np.cos(t)) * np.sin(x)

    for i in range(periods * steps):
        t = (i % steps) * h
        a = slope(t, theta, velocity)
        b = slope(t + h / 2, theta + h / 2 * a[0], velocity + h / 2 * a[1])
        c = slope(t + h / 2, theta + h / 2 * b[0], velocity + h / 2 * b[1])
        d = slope(t + h, theta + h * c[0], velocity + h * c[1])
        theta = theta + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        velocity = velocity + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
    return np.array([theta, velocity])


def ends(pendulum, starts, periods, steps=40):
    """Where each start ends: 0 down, 1 inverted, else ten times its turns in the last 20 periods."""
    before = runge_kutta(pendulum, starts, periods - 20, steps)
    theta, _ = runge_kutta(pendulum, before, 20, steps)
    turns = np.rint((theta - before[0]) / (2 * np.pi))
    return np.where(turns != 0, 10 * turns, np.cos(theta) < 0)


def main():
    side = int(sys.argv[1]) if len(sys.argv) > 1 else 50
    angles = (2 * np.arange(side) + 1 - side) * np.pi / side
    for name, (k, beta, m, fastest, periods) in RIGS.items():
        starts = np.array(np.meshgrid(angles, angles / np.pi * fastest)).reshape(2, -1)
        pendulum = {"k": k, "beta": beta, "m": m}
        floor = np.mean(ends(pendulum, starts, periods) != ends(pendulum, starts, periods, 60))
        more = np.mean(ends(pendulum, starts, periods) != ends(pendulum | {"beta": 1.01 * beta}, starts, periods))
        print(f"{name}: {side * side} starts; other steps change {100 * floor:.2f} %, 1 % more friction "
              f"{100 * more:.1f} %", flush=True)
        for drag in DRAGS:
            rig = ends(pendulum | {"drag": drag}, starts, periods)
            for swing in (10, 40):
                viscous = beta + 8 / (3 * np.pi) * drag * np.sqrt(k) * np.radians(swing)
                scene = ends(pendulum | {"beta": viscous}, starts, periods)
                shares = ", ".join(f"{word} {100 * np.mean(rig == code):.1f} and {100 * np.mean(scene == code):.1f} %"
                                   for word, code in (("down", 0), ("inverted", 1)))
                differ = 100 * np.mean(rig != scene)
                print(f"  drag {drag}, equal at {swing} deg: {differ:.1f} % of the labels differ; rig and scene: "
                      f"{shares}", flush=True)


if __name__ == "__main__":
    main()

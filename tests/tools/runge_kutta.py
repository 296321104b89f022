"""The motion by the classical Runge-Kutta method: what the program's cycles and curves are compared with."""

import numpy as np


def runge_kutta(pendulum, state, periods, steps, kind=np.longdouble):
    """The state, (angle, velocity) or arrays of them, after whole drive periods; angles are not wrapped.
    `drag`: of friction drag |v| v beside the viscous one."""
    k, beta, m, drag = (kind(pendulum.get(name, 0)) for name in ("k", "beta", "m", "drag"))
    theta, velocity = (np.array(part, dtype=kind) for part in state)
    h = 2 * np.arccos(kind(-1)) / steps

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

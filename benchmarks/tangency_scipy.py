"""The drive m at which the manifolds of the inverted state touch, without kapitza.

For a start on the unstable manifold, the drive at which its motion just comes back to the top is found by halving: with
more drive it goes over, with less it falls back. The lowest of these drives over all starts is the tangency.

    scripts/benchmark tangency_scipy K BETA LOW HIGH
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar

NEAR = 1e-5  # rad from the top, which is its own mirror image: the manifold leaves its tangent by the third power
SETTINGS = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-15}
TURN = 2 * np.pi


def field(t, y, k, beta, m):
    """Angles from the top: x'' + beta x' - (k - m cos t) sin x = 0."""
    return [y[1], -beta * y[1] + (k - m * np.cos(t)) * np.sin(y[0])]


def unstable(k, beta, m):
    """Multiplier and unit eigenvector of the top."""
    columns = [solve_ivp(lambda t, y: [y[1], -beta * y[1] + (k - m * np.cos(t)) * y[0]], (0, TURN), e,
                         **SETTINGS).y[:, -1]
               for e in np.eye(2)]
    values, vectors = np.linalg.eig(np.transpose(columns))
    i = np.argmax(values.real)
    return values[i].real, vectors[:, i].real * np.sign(vectors[0, i].real)


def goes_over(k, beta, m, share):
    """Whether the motion from a start on the manifold, a share of a return from NEAR, goes over the top after one
    turn."""
    multiplier, direction = unstable(k, beta, m)

    def over(t, y, *_):
        return y[0] - (TURN + 0.5)

    def back(t, y, *_):
        return y[1]

    over.terminal = back.terminal = True
    end = solve_ivp(field, (0, 40 * TURN), NEAR * multiplier**share * direction, args=(k, beta, m), events=(over, back),
                    **SETTINGS)
    final = end.y[:, -1]
    return final[0] > TURN + 0.1


def drive_of(k, beta, low, high, share):
    while high - low > 2e-14 * high:
        middle = (low + high) / 2
        low, high = (low, middle) if goes_over(k, beta, middle, share) else (middle, high)
        if middle in (low, high) and high - low < 1e-15:
            break
    return (low + high) / 2


def main():
    k, beta, low, high = map(float, sys.argv[1:])
    shares = np.arange(8) / 8
    coarse = [drive_of(k, beta, low, high, share) if goes_over(k, beta, high, share) else np.inf for share in shares]
    start = shares[np.argmin(coarse)]
    best = minimize_scalar(lambda share: drive_of(k, beta, low, high, share),
                           bracket=(start - 1 / 8, start, start + 1 / 8), tol=1e-6)
    print(f"m = {best.fun:.14g} at {best.x:.6f} of a return")


if __name__ == "__main__":
    main()

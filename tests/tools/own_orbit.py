"""Where one start of any number of digits ends: an integrator of its own, in whole numbers, for the referee of deep windows.

A Taylor series of theta'' + beta theta' + (k - m cos t) sin theta = 0 in fixed point; nothing is shared with the program but the equation.
The tangent map, in floats, tells how much an error has grown, and so how many bits are still of use.
"""

import math
from fractions import Fraction
from operator import mul

import mpmath

GUARD, FEWEST_BITS = 110, 90
NEAR = 1e-4  # rad: of a strobe point of an attractor, within its basin
LARGEST_TURN = 2.5  # rad: of a step


def fixed(value, bits):
    """A number as a multiple of 2^-bits."""
    return round(Fraction(value) * 2**bits)


def from_mpmath(value, bits):
    return int(mpmath.nint(mpmath.ldexp(value, bits)))


class Steps:
    """Constants of a period in n steps with so many bits."""

    def __init__(self, pendulum, n, bits):
        k, beta, m = pendulum
        self.n, self.bits = n, bits
        with mpmath.workprec(bits + 20):
            h = 2 * mpmath.pi / n
            self.h, self.damping = from_mpmath(h, bits), from_mpmath(h * beta, bits)
            self.turn = from_mpmath(2 * mpmath.pi, bits)
            self.force, self.gain = [], []
            for i in range(n):
                cosine, sine = mpmath.cos(h * i), mpmath.sin(h * i)
                circle, scale, row = (cosine, -sine, -cosine, sine), m * h * h, []
                while abs(scale) > mpmath.ldexp(1, -bits - 4):
                    row.append(from_mpmath(-scale * circle[len(row) % 4], bits))
                    scale *= h / len(row)
                row[0] += from_mpmath(k * h * h, bits)
                self.force.append(row)
                self.gain.append([force / 2**bits for force in row])


def product(a, b, n):
    """Coefficient n of the product of two series."""
    return sum(map(mul, a, b[n::-1]))


def expand(steps, i, place):
    """Series of speed, sine and cosine on step i."""
    bits, force = steps.bits, steps.force[i]
    theta, velocity = place
    with mpmath.workprec(bits + 20):
        angle = mpmath.ldexp(mpmath.mpf(theta), -bits)
        s, c = [from_mpmath(mpmath.sin(angle), bits)], [from_mpmath(mpmath.cos(angle), bits)]
    w = [velocity * steps.h >> bits]
    while len(w) < 3 or any(abs(row[-1]) + abs(row[-2]) > 1 for row in (w, s, c)):
        n = len(w) - 1
        torque = product(force, s, n) + steps.damping * w[n]
        s_next, c_next = product(w, c, n), -product(w, s, n)
        w.append(-(torque >> bits) // (n + 1))
        s.append((s_next >> bits) // (n + 1))
        c.append((c_next >> bits) // (n + 1))
    return w, s, c


def move_tangent(steps, i, c, tangent):
    """The tangent map (rows theta, velocity) through step i, in floats."""
    orders, h, damping = min(len(c), 40), steps.h / 2**steps.bits, steps.damping / 2**steps.bits
    cosine = [value / 2**steps.bits for value in c[:orders]]
    gain = [product(steps.gain[i], cosine, n) for n in range(orders)]
    for axis in range(2):
        x, y = [tangent[0][axis]], [h * tangent[1][axis]]
        for n in range(orders - 1):
            x.append(y[n] / (n + 1))
            y.append(-(damping * y[n] + product(gain, x, n)) / (n + 1))
        tangent[0][axis], tangent[1][axis] = sum(x), sum(y) / h


class Orbit:
    """The orbit of a start given as fractions, and how much errors have grown on it."""

    def __init__(self, pendulum, start, bits):
        self.pendulum, self.bits, self.all = pendulum, bits, bits
        self.place = [fixed(start[0], bits), fixed(start[1], bits)]
        self.tangent, self.growth, self.largest = [[1.0, 0.0], [0.0, 1.0]], 0.0, 0.0
        self.known = {}

    def steps(self):
        fastest = abs(self.place[1]) / 2**self.bits + 2 * (abs(self.pendulum[0]) + abs(self.pendulum[2]))
        n = 16
        while 2 * math.pi / n * fastest > LARGEST_TURN:
            n *= 2
        if (n, self.bits) not in self.known:
            self.known[n, self.bits] = Steps(self.pendulum, n, self.bits)
        return self.known[n, self.bits]

    def drop_bits(self):
        """To a multiple of 16 that is well below the error so far."""
        bits = min(self.bits, max(FEWEST_BITS, 16 * math.ceil((self.all - self.growth + 20) / 16)))
        self.place = [value >> self.bits - bits for value in self.place]
        self.bits = bits

    def advance(self):
        steps = self.steps()
        for i in range(steps.n):
            w, s, c = expand(steps, i, self.place)
            self.place[0] += sum(value // (n + 1) for n, value in enumerate(w))
            self.place[1] = (sum(w) << self.bits) // steps.h
            move_tangent(steps, i, c, self.tangent)
        self.place[0] = (self.place[0] + steps.turn // 2) % steps.turn - steps.turn // 2
        size = max(map(abs, self.tangent[0] + self.tangent[1]))
        self.growth += math.log2(size)
        self.largest = max(self.largest, self.growth)
        self.tangent = [[value / size for value in row] for row in self.tangent]
        self.drop_bits()

    def state(self):
        return tuple(value / 2**self.bits for value in self.place)

    def lost(self):
        """Whether the error, of one last place a period, has become visible."""
        return self.largest > self.all - 50


def end_of(pendulum, start, strobes, digits, most_periods=3000):
    """The number of the attractor that the orbit of a start comes to, by lists of their strobe points; None where it comes to none.

    start: two fractions or decimal texts; digits: that tell it from its neighbours."""
    bits = math.ceil(digits * math.log2(10)) + GUARD
    while True:
        orbit = Orbit(pendulum, [Fraction(value) for value in start], bits)
        for _ in range(most_periods):
            orbit.advance()
            if orbit.lost():
                break
            theta, velocity = orbit.state()
            for number, points in enumerate(strobes):
                if any(math.hypot(math.remainder(theta - a, 2 * math.pi), velocity - b) < NEAR for a, b in points):
                    return number
        else:
            return None
        bits = 2 * bits - 64

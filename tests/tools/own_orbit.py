"""Where starts of any number of digits end: an integrator of its own, in whole numbers, for the referee of deep
windows.

A Taylor series of theta'' + beta theta' + a(t) sin theta - b(t) cos theta = torque in fixed point; nothing is shared
with the program but the equation. A pendulum is (k, beta, m), or (k, beta, m, vertical, horizontal, torque) with lists
of (cosine, sine) of the harmonics. Motions begin at a strobe, or at any phase of the drive before one.
The tangent map, in floats, tells how much an error has grown, and so how many bits are still of use.

Starts beside a common one take less time: the orbit of that one has all digits, and each start's difference from it
obeys the exact equation of the difference, which takes few digits of its own however small it is.
"""

import math
from fractions import Fraction
from operator import mul

import mpmath

try:
    from gmpy2 import mpz  # integers that are several times as fast
except ImportError:
    mpz = int

GUARD, FEWEST_BITS = 110, 90
OWN_BITS = 104  # bits of a difference
WIDE = 20  # bits: a difference above 2^-20 rad becomes an orbit
NEAR = 1e-4  # rad: of a strobe point of an attractor, within its basin
LARGEST_TURN = 2.5  # rad: of a step


def fixed(value, bits):
    """A number as a multiple of 2^-bits."""
    return mpz(round(Fraction(value) * 2**bits))


def from_mpmath(value, bits):
    return mpz(int(mpmath.nint(mpmath.ldexp(value, bits))))


class Steps:
    """Constants of a period, from the phase on at which a motion is released, in n steps with so many bits."""

    def __init__(self, pendulum, n, bits, phase=0):
        k, beta, m, vertical, horizontal, torque = (*pendulum, [], [], 0.0)[:6]
        self.n, self.bits = n, bits
        with mpmath.workprec(bits + 20):
            begin = mpmath.mpf(phase) % (2 * mpmath.pi)
            h = (2 * mpmath.pi - begin) / n
            self.h, self.damping = from_mpmath(h, bits), from_mpmath(h * beta, bits)
            self.turn = from_mpmath(2 * mpmath.pi, bits)
            self.torque = from_mpmath(h * h * torque, bits)
            self.force, self.across, self.gain = [], [], []
            for i in range(n):
                at = begin + h * i
                row = drive_series([(1, m, 0.0)] + [(j + 1, *parts) for j, parts in enumerate(vertical)], h, at, bits)
                row[0] += from_mpmath(k * h * h, bits)
                self.force.append(row)
                self.across.append(drive_series([(j + 1, *parts) for j, parts in enumerate(horizontal)], h, at, bits))
                self.gain.append([[value / 2**bits for value in series] for series in (row, self.across[-1])])


def drive_series(harmonics, h, at, bits):
    """-h^2 times the sum of (order, cosine, sine) over the step that begins then."""
    row = [mpz(0)]
    for order, cosine, sine in harmonics:
        if cosine == 0 and sine == 0:
            continue
        c, s = mpmath.cos(order * at), mpmath.sin(order * at)
        circle, scale, n = (cosine * c + sine * s, sine * c - cosine * s), h * h, 0
        while abs(scale) * (abs(cosine) + abs(sine)) > mpmath.ldexp(1, -bits - 4):
            row.extend([mpz(0)] * (n + 1 - len(row)))
            row[n] -= from_mpmath(scale * circle[n % 2] * (-1)**(n // 2), bits)
            n += 1
            scale *= order * h / n
    return row


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
        torque = later(force, s, n) + later(steps.across[i], c,
                                            n) + steps.damping * w[n] - (n == 0) * (steps.torque << bits)
        s_next, c_next = product(w, c, n), -product(w, s, n)
        w.append(-(torque >> bits) // (n + 1))
        s.append((s_next >> bits) // (n + 1))
        c.append((c_next >> bits) // (n + 1))
    return w, s, c


def move_tangent(steps, i, s, c, tangent):
    """The tangent map (rows theta, velocity) through step i, in floats."""
    orders, h, damping = min(len(c), 40), steps.h / 2**steps.bits, steps.damping / 2**steps.bits
    cosine, sine = ([value / 2**steps.bits for value in row[:orders]] for row in (c, s))
    along, across = steps.gain[i]
    gain = [later(along, cosine, n) - later(across, sine, n) for n in range(orders)]
    for axis in range(2):
        x, y = [tangent[0][axis]], [h * tangent[1][axis]]
        for n in range(orders - 1):
            x.append(y[n] / (n + 1))
            y.append(-(damping * y[n] + product(gain, x, n)) / (n + 1))
        tangent[0][axis], tangent[1][axis] = sum(x), sum(y) / h


class Orbit:
    """The orbit of a start given as fractions, and how much errors have grown on it."""

    def __init__(self, pendulum, start, bits, phase=0):
        self.pendulum, self.bits, self.all, self.phase = pendulum, bits, bits, phase
        self.place = [fixed(start[0], bits), fixed(start[1], bits)]
        self.tangent, self.growth, self.largest = [[1.0, 0.0], [0.0, 1.0]], 0.0, 0.0
        self.known = {}

    def steps(self):
        harmonics = [part for rows in self.pendulum[3:5] for row in rows for part in row]
        fastest = abs(self.place[1]) / 2**self.bits + 2 * (abs(self.pendulum[0]) + abs(self.pendulum[2])
                                                           + sum(map(abs, harmonics)))
        n = 16
        while 2 * math.pi / n * fastest > LARGEST_TURN:
            n *= 2
        key = n, self.bits, self.phase
        if key not in self.known:
            self.known[key] = Steps(self.pendulum, *key)
        return self.known[key]

    def drop_bits(self):
        """To a multiple of 16 that is well below the error so far."""
        bits = min(self.bits, max(FEWEST_BITS, 16 * math.ceil((self.all - self.growth + 20) / 16)))
        self.place = [value >> self.bits - bits for value in self.place]
        self.bits = bits

    def advance(self, beside=()):
        """To the next strobe; the differences `beside` go with it."""
        steps = self.steps()
        self.phase = 0
        for i in range(steps.n):
            w, s, c = expand(steps, i, self.place)
            if beside:
                rows = [shortened(row, self.bits - OWN_BITS) for row in (w, s, c, steps.force[i], steps.across[i])]
                for difference in beside:
                    difference.step(steps, self.place[0], rows)
            self.place[0] += sum(value // (n + 1) for n, value in enumerate(w))
            self.place[1] = (sum(w) << self.bits) // steps.h
            move_tangent(steps, i, s, c, self.tangent)
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


def shortened(row, by):
    """The coefficients of a series with `by` fewer bits, as many as are left."""
    row = [value >> by for value in row]
    while len(row) > 1 and -1 <= row[-1] <= 0:
        row.pop()
    return row


class Difference:
    """A start's orbit minus the common one, in units of 2^-(OWN_BITS + scale)."""

    def __init__(self, offset):
        """offset: two fractions, rad and rad per drive radian."""
        size = max(map(abs, offset))
        self.scale = (-math.frexp(size)[1]
                      if size > 1e-300 else size.denominator.bit_length() - size.numerator.bit_length())
        self.first, self.place = self.scale, [fixed(value * 2**self.scale, OWN_BITS) for value in offset]

    def starting_state(self, theta, bits):
        """Changes of sine and cosine: 2 cos(theta + d/2) sin(d/2) and -2 sin(theta + d/2) sin(d/2)."""
        with mpmath.workprec(OWN_BITS + 20):
            half = mpmath.ldexp(mpmath.mpf(self.place[0]), -OWN_BITS - self.scale - 1)
            middle, change = mpmath.ldexp(mpmath.mpf(theta),
                                          -bits) + half, mpmath.ldexp(2 * mpmath.sin(half), self.scale)
            return [from_mpmath(change * mpmath.cos(middle), OWN_BITS)], [from_mpmath(-change * mpmath.sin(middle),
                                                                                      OWN_BITS)]

    def step(self, steps, theta, rows):
        """Through a step of the common orbit, from its angle there and its series of speed, sine, cosine and force."""
        w, s, c, force, across = rows
        a, b = self.starting_state(theta, steps.bits)
        h, damping = steps.h >> steps.bits - OWN_BITS, steps.damping >> steps.bits - OWN_BITS
        u, sine, cosine = [self.place[1] * h >> OWN_BITS], [], []
        while len(u) < 3 or any(abs(row[-1]) + abs(row[-2]) > 2 for row in (u, a, b)):
            n = len(u) - 1
            sine.append((s[n] if n < len(s) else 0) + (a[n] >> self.scale))
            cosine.append((c[n] if n < len(c) else 0) + (b[n] >> self.scale))
            a_next, b_next = later(w, b, n) + product(cosine, u, n), -later(w, a, n) - product(sine, u, n)
            torque = later(force, a, n) + later(across, b, n) + damping * u[n]
            u.append(-(torque >> OWN_BITS) // (n + 1))
            a.append((a_next >> OWN_BITS) // (n + 1))
            b.append((b_next >> OWN_BITS) // (n + 1))
        self.place[0] += sum(value // (n + 1) for n, value in enumerate(u))
        self.place[1] = (sum(u) << OWN_BITS) // h

    def scale_anew(self):
        by = OWN_BITS - max(abs(value) for value in self.place).bit_length()
        by = max(by, -self.scale)
        self.place = [value << by if by > 0 else value >> -by for value in self.place]
        self.scale += by

    def lost(self, growth):
        """Whether it has grown so much less than errors may have, by 2^growth, that these could be seen."""
        return growth - (self.first - self.scale) > OWN_BITS / 3

    def orbit(self, common):
        """The start's own orbit from here on."""
        own = Orbit(common.pendulum, (0, 0), OWN_BITS)
        own.place = [(value >> common.bits - OWN_BITS) + (change >> self.scale)
                     for value, change in zip(common.place, self.place, strict=True)]
        return own


def later(a, b, n):
    """Coefficient n of the product of a series that may have ended before and another one."""
    return sum(map(mul, a, b[n::-1])) if n < len(a) else sum(map(mul, a, b[n:n - len(a):-1]))


def arrival(orbit, strobes):
    """The number of the attractor whose strobe point the orbit is at; None."""
    theta, velocity = orbit.state()
    for number, points in enumerate(strobes):
        if any(math.hypot(math.remainder(theta - a, 2 * math.pi), velocity - b) < NEAR for a, b in points):
            return number
    return None


def follow(orbit, strobes, most_periods):
    """The number of the attractor that it comes to, and whether it came to one, or to none in so many periods, before
    it was lost."""
    for _ in range(most_periods):
        orbit.advance()
        if orbit.lost():
            return None, False
        end = arrival(orbit, strobes)
        if end is not None:
            return end, True
    return None, True


def end_of(pendulum, start, strobes, digits, most_periods=3000, phase=0):
    """The number of the attractor that the orbit of a start comes to, by lists of their strobe points; None where it
    comes to none.

    start: two fractions or decimal texts; digits: that tell it from its neighbours; phase: of the drive at the start, a
    double."""
    bits, found = math.ceil(digits * math.log2(10)) + GUARD, False
    while not found:
        end, found = follow(Orbit(pendulum, [Fraction(value) for value in start], bits, phase), strobes, most_periods)
        bits = 2 * bits - 64
    return end


def ends_beside(pendulum, centre, offsets, strobes, digits, most_periods=3000):
    """The same of the starts at `offsets` from a common one; digits: that tell them apart. Those that lose theirs are
    followed alone."""
    common = Orbit(pendulum, centre, math.ceil(digits * math.log2(10)) + GUARD)
    differences, ends = {i: Difference(offset) for i, offset in enumerate(offsets)}, {}
    for _ in range(most_periods):
        common.advance(differences.values())
        ended = arrival(common, strobes)
        for i, difference in list(differences.items()):
            difference.scale_anew()
            is_lost, is_wide = difference.lost(common.growth), difference.scale < WIDE
            if not (is_lost or is_wide or ended is not None):
                continue
            end, found = (ended, not is_lost) if not is_wide else (None, False) if is_lost else follow(
                difference.orbit(common), strobes, most_periods)
            start = [middle + offset for middle, offset in zip(centre, offsets[i], strict=True)]
            ends[i] = end if found else end_of(pendulum, start, strobes, digits, most_periods)
            del differences[i]
        if not differences:
            break
    return [ends.get(i) for i in range(len(offsets))]

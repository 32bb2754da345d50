"""Boxes with two adjacent sides, each flush with a given edge: a curve of frames, and bounds on their volume.

The outward normals a and b of the two sides lie on the Gauss arcs of their edges and are orthogonal, which
leaves one freedom. With a(x) = a + x a' and b(y) = b + y b' (not normalised), where a' is the edge's
direction times a, orthogonality ties y to x by y = -p x / (q + r x).

For any two points of the solid, the distance along a direction is at most the solid's width along it. With
two points held fast for each of the three directions a, b and a x b, the product of the three distances is
N(x) / D(x) with quartic N and D, and bounds the volume from below. On an interval where the three distances
are positive, N - limit D is not negative where its Bernstein coefficients are not.
"""

from typing import NamedTuple

from regolith_studio.geometry.kernels import inner_kernel
from regolith_studio.geometry.vectors import Vector, cross, dot, length, mixed

MIN_LEVER = 1e-9
"""Where a is that close to the second edge's direction, b is not determined."""


class Curve(NamedTuple):
    """Frames (a + x a_turn, b + y b_turn, their cross product) with y = -p x / (q + r x), low <= x <= high.

    A curve with q = 0 holds nothing; else q > 0, and q + r x > 0 all along.
    """

    a: Vector
    a_turn: Vector
    b: Vector
    b_turn: Vector
    p: float
    q: float
    r: float
    low: float
    high: float


class Factors(NamedTuple):
    """Three distances along a, b and c times what makes them polynomials in x: a0 + a1 x and so on."""

    a0: float
    a1: float
    b0: float
    b1: float
    c0: float
    c1: float
    c2: float


class Quartic(NamedTuple):
    """Coefficients of a polynomial, the constant first."""

    k0: float
    k1: float
    k2: float
    k3: float
    k4: float


@inner_kernel
def unit(vector: Vector) -> Vector:
    """The vector at length 1."""
    return scaled(vector, 1.0 / length(vector))


@inner_kernel
def scaled(vector: Vector, share: float) -> Vector:
    """``share * vector``."""
    return share * vector[0], share * vector[1], share * vector[2]


@inner_kernel
def curve_between(
    edge_a: Vector, edge_b: Vector, a_from: Vector, b_from: Vector, a_to: Vector, b_to: Vector
) -> Curve:
    """The curve from the frame (a_from, b_from) to (a_to, b_to); a must turn at least as far as b.

    ``edge_a``, ``edge_b``: unit directions of the edges; a turns about `edge_a`, b about `edge_b`.
    """
    a = unit(mixed(a_from, 1.0, a_to, 1.0))
    b = cross(edge_b, a)
    lever = length(b)
    if lever < MIN_LEVER:
        return Curve(a, a, b, b, 0.0, 0.0, 0.0, 0.0, 0.0)
    if dot(b, b_from) + dot(b, b_to) < 0.0:
        lever = -lever
    b = mixed(b, 1.0 / lever, b, 0.0)
    a_turn, b_turn = cross(edge_a, a), cross(edge_b, b)
    one, two = dot(a_from, a_turn) / dot(a_from, a), dot(a_to, a_turn) / dot(a_to, a)
    p, q, r = dot(a_turn, b), dot(a, b_turn), dot(a_turn, b_turn)
    if q < 0.0:
        p, q, r = -p, -q, -r
    return Curve(a, a_turn, b, b_turn, p, q, r, min(one, two), max(one, two))


@inner_kernel
def directions_on(curve: Curve, x: float) -> tuple[Vector, Vector, Vector]:
    """The three axes at x, longer than 1."""
    y = -curve.p * x / (curve.q + curve.r * x)
    a, b = mixed(curve.a, 1.0, curve.a_turn, x), mixed(curve.b, 1.0, curve.b_turn, y)
    return a, b, cross(a, b)


@inner_kernel
def frame_on(curve: Curve, x: float) -> tuple[Vector, Vector, Vector]:
    """The three unit axes at x."""
    a, b, _ = directions_on(curve, x)
    a, b = unit(a), unit(b)
    return a, b, cross(a, b)


@inner_kernel
def factors_of(curve: Curve, span_a: Vector, span_b: Vector, span_c: Vector, x: float) -> Factors:
    """Distances between points along the three axes; spans are the points' differences.

    Signs are chosen so that all are positive at x.
    """
    p, q, r = curve.p, curve.q, curve.r
    a0, a1 = dot(span_a, curve.a), dot(span_a, curve.a_turn)
    b0, b1 = dot(span_b, curve.b), dot(span_b, curve.b_turn)
    along_a, along_turn = cross(span_c, curve.a), cross(span_c, curve.a_turn)
    c00, c10 = dot(along_a, curve.b), dot(along_turn, curve.b)
    c01, c11 = dot(along_a, curve.b_turn), dot(along_turn, curve.b_turn)
    b0, b1 = b0 * q, b0 * r - b1 * p
    c0, c1, c2 = c00 * q, c00 * r + c10 * q - c01 * p, c10 * r - c11 * p
    if a0 + x * a1 < 0.0:
        a0, a1 = -a0, -a1
    if b0 + x * b1 < 0.0:
        b0, b1 = -b0, -b1
    if c0 + x * (c1 + x * c2) < 0.0:
        c0, c1, c2 = -c0, -c1, -c2
    return Factors(a0, a1, b0, b1, c0, c1, c2)


@inner_kernel
def numerator(factors: Factors) -> Quartic:
    """N: the product of the three distances."""
    a0, a1, b0, b1, c0, c1, c2 = factors
    m0, m1, m2 = a0 * b0, a0 * b1 + a1 * b0, a1 * b1
    return Quartic(m0 * c0, m0 * c1 + m1 * c0, m0 * c2 + m1 * c1 + m2 * c0, m1 * c2 + m2 * c1, m2 * c2)


@inner_kernel
def denominator(curve: Curve) -> Quartic:
    """D: what the lengths of a(x) and b(y) divide the product by, (1 + x^2) ((q + r x)^2 + p^2 x^2)."""
    p, q, r = curve.p, curve.q, curve.r
    last = r * r + p * p
    return Quartic(q * q, 2.0 * q * r, q * q + last, 2.0 * q * r, last)


@inner_kernel
def value(f: Quartic, x: float) -> float:
    """The polynomial at x."""
    return f.k0 + x * (f.k1 + x * (f.k2 + x * (f.k3 + x * f.k4)))


@inner_kernel
def derivative(f: Quartic, x: float) -> float:
    """Its derivative at x."""
    return f.k1 + x * (2.0 * f.k2 + x * (3.0 * f.k3 + x * 4.0 * f.k4))


@inner_kernel
def all_positive(factors: Factors, low: float, high: float) -> bool:
    """Whether the three distances are positive on an interval; False where that is not certain."""
    a0, a1, b0, b1, c0, c1, c2 = factors
    if min(a0 + a1 * low, a0 + a1 * high) <= 0.0 or min(b0 + b1 * low, b0 + b1 * high) <= 0.0:
        return False
    ends = min(c0 + low * (c1 + low * c2), c0 + high * (c1 + high * c2))
    # The third number is the middle Bernstein coefficient of the quadratic.
    return bool(min(ends, c0 + 0.5 * c1 * (low + high) + c2 * low * high) > 0.0)


@inner_kernel
def is_above_limit(top: Quartic, bottom: Quartic, limit: float, low: float, high: float) -> bool:
    """Whether all Bernstein coefficients of top - limit * bottom on an interval are at least 0."""
    k0, k1, k2 = top.k0 - limit * bottom.k0, top.k1 - limit * bottom.k1, top.k2 - limit * bottom.k2
    k3, k4 = top.k3 - limit * bottom.k3, top.k4 - limit * bottom.k4
    h = high - low
    t0 = k0 + low * (k1 + low * (k2 + low * (k3 + low * k4)))
    t1 = h * (k1 + low * (2.0 * k2 + low * (3.0 * k3 + low * 4.0 * k4)))
    t2 = h * h * (k2 + low * (3.0 * k3 + low * 6.0 * k4))
    t3 = h * h * h * (k3 + low * 4.0 * k4)
    t4 = h * h * h * h * k4
    middle = min(t0 + t1 / 2.0 + t2 / 6.0, t0 + 0.75 * t1 + 0.5 * t2 + 0.25 * t3)
    return bool(min(min(t0, t0 + t1 / 4.0), min(middle, t0 + t1 + t2 + t3 + t4)) >= 0.0)


@inner_kernel
def argmin_ratio(top: Quartic, bottom: Quartic, low: float, high: float) -> float:
    """Where top / bottom is least on an interval with one minimum; else some place that tends to it."""
    at_low = derivative(top, low) * value(bottom, low) - value(top, low) * derivative(bottom, low)
    at_high = derivative(top, high) * value(bottom, high) - value(top, high) * derivative(bottom, high)
    if at_low >= 0.0 or at_high <= 0.0:
        first = value(top, low) * value(bottom, high) <= value(top, high) * value(bottom, low)
        return low if first else high
    x = low
    for step in range(60):
        # Two steps of regula falsi, which may approach from one side only, and one of bisection.
        x = low - at_low * (high - low) / (at_high - at_low) if step % 3 < 2 else 0.5 * (low + high)
        slope = derivative(top, x) * value(bottom, x) - value(top, x) * derivative(bottom, x)
        if slope < 0.0:
            low, at_low = x, slope
        else:
            high, at_high = x, slope
        if high - low < 1e-10 or slope == 0.0:
            break
    return x


@inner_kernel
def crossing(one: Quartic, two: Quartic, low: float, high: float) -> float:
    """Where two polynomials are equal, between places where different ones are larger; else the middle."""
    f_low, f_high = value(one, low) - value(two, low), value(one, high) - value(two, high)
    if f_low * f_high > 0.0 or f_low == f_high:
        return 0.5 * (low + high)
    x = low
    for step in range(60):
        # Two steps of regula falsi, which may approach from one side only, and one of bisection.
        x = low - f_low * (high - low) / (f_high - f_low) if step % 3 < 2 else 0.5 * (low + high)
        f = value(one, x) - value(two, x)
        if f * f_low > 0.0:
            low, f_low = x, f
        else:
            high, f_high = x, f
        if f == 0.0 or abs(high - low) < 1e-14:
            break
    return x

"""Closed splines against scipy.interpolate.BSpline, to 1e-9, for every order; area and centroid against scipy's quadrature.

    splines_test.py PROGRAM      PROGRAM is spline_points; exits 77 (skipped) where scipy is not installed
"""
import subprocess
import sys

try:
    import numpy as np
    from scipy.interpolate import BSpline
    from scipy.integrate import quad
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)


def reference(points, order):
    """The same curve as scipy builds it: uniform knots, the control points repeated so that they close, u shifted so that control
    point i pulls most at u = i."""
    count, degree = len(points), order - 1
    repeated = np.vstack([points[(i - degree) % count] for i in range(count + 2 * degree + 1)])
    knots = np.arange(len(repeated) + order) - degree - (order / 2 - degree) - degree
    return BSpline(knots, repeated, degree, extrapolate=False)


def check(program, order, count, seed):
    lines = subprocess.run([program, str(order), str(count), str(seed)], check=True, capture_output=True, text=True).stdout.splitlines()
    points = np.array(lines[0].split(), float).reshape(-1, 2)
    area, *centre, length = map(float, lines[1].split())
    table = np.array([line.split() for line in lines[2:]], float)
    curve = reference(points, order)
    slope = curve.derivative()
    worst = np.abs(curve(table[:, 0]) - table[:, 1:3]).max()
    if order == 2:  # the derivative jumps at the knots: look between them
        table = table[table[:, 0] % 1 != 0]
    worst = max(worst, np.abs(slope(table[:, 0]) - table[:, 3:5]).max())

    def integral(f):
        spans = np.arange(0, count + 0.25, 0.5)
        return sum(quad(f, a, b, epsabs=1e-10)[0] for a, b in zip(spans[:-1], spans[1:]))

    true_area = integral(lambda u: curve(u)[0] * slope(u)[1])
    true_centre = np.array([integral(lambda u: curve(u)[0] ** 2 / 2 * slope(u)[1]), -integral(lambda u: curve(u)[1] ** 2 / 2 * slope(u)[0])])
    true_length = integral(lambda u: np.hypot(*slope(u)))
    worst = max(worst, abs(area / true_area - 1), np.abs(centre - true_centre / true_area).max() / 100)
    assert worst < 1e-8, f"order {order}, {count} points, seed {seed}: off by {worst}"
    assert abs(length / true_length - 1) < 1e-3, f"length {length}, scipy says {true_length}"
    return worst


def main():
    worst = 0
    for order in range(2, 9):
        for seed, count in enumerate((max(order, 3), 12, 24)):
            worst = max(worst, check(sys.argv[1], order, count, seed))
    print(f"closed splines agree with scipy: largest difference {worst:.2e}")


if __name__ == "__main__":
    main()

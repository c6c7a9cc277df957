"""Cameras of OpenPTV, read by `marey convert`, against OpenPTV's own library: the same points in the same pixels.

    openptv_test.py PROGRAM [SEED]      PROGRAM is marey; exits 77 (skipped) where the library is not installed
"""
import math
import pathlib
import random
import subprocess
import sys
import tempfile
import tomllib
import unittest

try:
    import numpy as np
    from optv.calibration import Calibration
    from optv.imgcoord import image_coordinates
    from optv.parameters import ControlParams
    from optv.transforms import convert_arr_metric_to_pixel
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

SIZE, PIXEL = (1280, 1024), (0.012, 0.0125)  # px; mm


def rotation(omega, phi, kappa):
    co, so, cp, sp, ck, sk = (f(a) for a in (omega, phi, kappa) for f in (math.cos, math.sin))
    return np.array([[cp * ck, -cp * sk, sp], [co * sk + so * sp * ck, co * ck - so * sp * sk, -so * cp],
                     [so * sk - co * sp * ck, so * ck + co * sp * sk, co * cp]])


def write_camera(path, rng, lens):
    """About 0.4 m before the origin, along z; `lens`: what of it differs from an ideal one."""
    angles = [rng.uniform(-0.2, 0.2) for _ in range(3)]
    R = rotation(*angles)
    place = 400 * R[:, 2] + [rng.uniform(-10, 10) for _ in range(3)]
    offset = [rng.uniform(-0.5, 0.5) if "offset" in lens else 0 for _ in range(2)]
    rows = "\n".join("  ".join(f"{v:.15f}" for v in row) for row in R)
    path.with_name(path.name + ".ori").write_text(
        f"{place[0]:.9f} {place[1]:.9f} {place[2]:.9f}\n  {angles[0]:.12f} {angles[1]:.12f} {angles[2]:.12f}\n\n{rows}\n\n"
        f"  {offset[0]:.6f} {offset[1]:.6f}\n  60.0\n\n  0.0001 0.0001 150.0\n")
    bent = "bent" in lens
    added = [rng.uniform(-4e-4, 4e-4) * bent, rng.uniform(-1e-6, 1e-6) * bent, rng.uniform(-1e-8, 1e-8) * bent, rng.uniform(-1e-4, 1e-4) * bent,
             rng.uniform(-1e-4, 1e-4) * bent, rng.uniform(0.99, 1.01) if "scaled" in lens else 1, rng.uniform(-2e-5, 2e-5) if "sheared" in lens else 0]
    path.with_name(path.name + ".addpar").write_text(" ".join(f"{v:.12g}" for v in added))


def theirs(path, points):
    camera = Calibration()
    camera.from_file(str(path) + ".ori", str(path) + ".addpar")
    control = ControlParams(1, image_size=SIZE, pixel_size=PIXEL)
    media = control.get_multimedia_params()
    media.set_n1(1.0)
    media.set_layers([1.0], [5.0])
    media.set_n3(1.0)
    return convert_arr_metric_to_pixel(image_coordinates(points, camera, media), control) - 0.5  # a pixel's centre is whole here


def ours(camera, points):
    at = points / 1000 @ np.array(camera["rotation"]).T + np.array(camera["translation"])
    x, y = at[:, 0] / at[:, 2], at[:, 1] / at[:, 2]
    k1, k2, p1, p2, k3, k4, k5, k6 = (camera.get("distortion", []) + [0] * 8)[:8]
    r2 = x * x + y * y
    radial = (1 + r2 * (k1 + r2 * (k2 + r2 * k3))) / (1 + r2 * (k4 + r2 * (k5 + r2 * k6)))
    u = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x)
    v = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y
    return np.stack([u, v], 1) * camera["focal"] + camera["principal"]


class OpenPtv(unittest.TestCase):
    def test_the_same_points_are_in_the_same_pixels(self):
        rng = random.Random(SEED)
        lenses = [set(), {"offset"}, {"bent"}, {"bent", "scaled"}, {"bent", "offset"}, {"bent", "offset", "scaled", "sheared"}]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "parameters").mkdir()
            (folder / "cal").mkdir()
            names = "".join(f"img/cam{i}.1\ncal/cam{i}.tif\n" for i in range(len(lenses)))
            (folder / "parameters" / "ptv.par").write_text(
                f"{len(lenses)}\n{names}1\n0\n1\n{SIZE[0]}\n{SIZE[1]}\n{PIXEL[0]}\n{PIXEL[1]}\n0\n1\n1\n1\n5\n")
            for i, lens in enumerate(lenses):
                write_camera(folder / "cal" / f"cam{i}.tif", rng, lens)
            done = subprocess.run([MAREY, "convert", folder, folder / "rig.toml"], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            rig = tomllib.loads((folder / "rig.toml").read_text())
            points = np.array([[rng.uniform(-40, 40) for _ in range(3)] for _ in range(200)])
            for i, (camera, lens) in enumerate(zip(rig["camera"], lenses, strict=True)):
                expected = theirs(folder / "cal" / f"cam{i}.tif", points)
                seen = ((expected >= 0) & (expected < SIZE)).all(axis=1)
                self.assertGreater(seen.sum(), 20)
                apart = np.abs(ours(camera, points) - expected)[seen].max()
                print(f"{sorted(lens)}: {apart:.2g} px apart at most, {seen.sum()} points")
                exact = not ("offset" in lens and "bent" in lens)
                self.assertLess(apart, 1e-4 if exact else 0.5, f"seed {SEED}, {sorted(lens)}")


if __name__ == "__main__":
    MAREY = sys.argv.pop(1)
    SEED = int(sys.argv.pop(1)) if len(sys.argv) > 1 else random.randrange(10**6)
    print(f"seed {SEED}")
    unittest.main(verbosity=2)

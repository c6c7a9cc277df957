"""The Python of docs/take.md reads the path of one track out of a take that `marey convert` writes.

    take_test.py PROGRAM      PROGRAM is marey; exits 77 (skipped) where numpy is not installed
"""
import csv
import pathlib
import random
import re
import subprocess
import sys
import tempfile

try:
    import numpy as np
except ImportError as missing:
    print(f"skipped: {missing}; script/setup installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def main(program):
    page = (ROOT / "docs" / "take.md").read_text()
    code = re.search(r"```python\n(.*?)```", page, re.DOTALL).group(1)
    documented = {}
    exec(code, documented)
    dice = random.Random(1)
    truth = {1: [], 2: [], 3: []}
    with tempfile.TemporaryDirectory() as folder:
        points, take = pathlib.Path(folder) / "a.csv", pathlib.Path(folder) / "a.marey"
        with open(points, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow("frame time id label x y z".split())
            for frame in range(9000):  # more than a minute: more than one chunk
                for track, path in truth.items():
                    if track > 1 and dice.random() < 0.2:
                        continue
                    place = [dice.uniform(-4, 4), dice.randrange(16) / 4, dice.uniform(0, 2)]
                    path.append([frame / 100, *place])
                    rows.writerow([frame, f"{frame / 100:.6f}", track, f"M{track}", *(f"{value:.17g}" for value in place)])
        subprocess.run([program, "convert", points, take, "--quiet"], check=True)
        for track, path in truth.items():
            times, places = documented["path_of"](take, track)
            wanted = np.array(path)
            assert places.shape == (len(path), 3), places.shape
            assert np.abs(times - wanted[:, 0]).max() < 1e-9
            assert (places == wanted[:, 1:]).all(), np.abs(places - wanted[:, 1:]).max()
            print(f"track {track}: {len(path)} rows")


if __name__ == "__main__":
    main(sys.argv[1])

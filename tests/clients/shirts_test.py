"""Shirt numbers as a user has them: in the file of `marey track --numbers` and in its overlay, in `marey live`, and the error where they cannot be read.

    shirts_test.py MAREY MODELS      exits 77 (skipped) where script/model --numbers has not run, or ffmpeg, Pillow, OpenCV or the fonts are not here

People are simulated and numbers drawn on them as bench/shirt_numbers.py does, which measures how often they are right.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
FRAMES, SEED = 100, 1


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


try:
    import cv2
    import numpy as np

    sys.path.insert(0, str(ROOT / "bench"))
    import shirt_numbers
except ImportError as missing:
    skip(f"{missing.name} is not installed (script/setup --tests)")


def numbers_in(path):
    return {int(row["id"]): (int(row["number"]), float(row["probability"])) for row in shirt_numbers.rows_of(path)}


def frames_of(video):
    capture = cv2.VideoCapture(str(video))
    while True:
        there, image = capture.read()
        if not there:
            return
        yield image.astype(np.int16)


def written_on(folder):
    """In how many frames the overlay with numbers has marks that the one without them lacks."""
    pairs = zip(frames_of(folder / "with.mp4"), frames_of(folder / "without.mp4"), strict=True)
    return [int((abs(a - b).max(axis=2) > 60).sum()) for a, b in pairs]


def main():
    marey, models = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
    if not pathlib.Path(models, "shirt_numbers.onnx").is_file():
        skip("script/model --numbers has not made the network")
    absent = [name for name in shirt_numbers.FONTS if not pathlib.Path(name).is_file()]
    if absent or shutil.which("ffmpeg") is None:
        skip(f"{absent[0] if absent else 'ffmpeg'} is not here")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)

        def run(*arguments, code=0, models=models):
            done = subprocess.run([marey, *map(str, arguments)], cwd=folder, capture_output=True, text=True, timeout=300, env=os.environ | {"MAREY_MODELS": str(models)})
            assert done.returncode == code, (arguments, done.returncode, done.stderr)
            return done.stderr

        run("simulate", "people", "--people", 3, "--height", 150, "--size", *shirt_numbers.SIZE, "--frames", FRAMES, "--rate", shirt_numbers.RATE, "--seed", SEED, "-o", ".", "-q")
        true, _ = shirt_numbers.with_numbers(folder, 23, SEED)
        run("track", "numbered.mp4", "-o", "with.csv", "--overlay", "with.mp4", "--numbers", "numbers.csv", "-q")
        run("track", "numbered.mp4", "-o", "without.csv", "--overlay", "without.mp4", "-q")
        run("track", "numbered.mp4", "--numbers", "alone.csv", "-q")
        assert (folder / "with.csv").read_text() == (folder / "without.csv").read_text(), "reading numbers changes no track"
        assert (folder / "numbers.csv").read_text() == (folder / "alone.csv").read_text(), "nor does the overlay change numbers"
        read = numbers_in(folder / "numbers.csv")
        named = [number for number, probability in read.values() if probability >= shirt_numbers.LIMIT]
        print(f"numbers {sorted(true.values())}; read: {read}")
        assert named and set(named) <= set(true.values()), (read, true)
        marks = written_on(folder)
        print(f"frames with a number in the overlay: {sum(one > 30 for one in marks)} of {len(marks)}")
        assert marks[-1] > 30 and sum(one > 30 for one in marks) > FRAMES / 4, marks

        run("live", "play:numbered.mp4", "--targets", "people", "--numbers", "live.csv", "-q")
        live = (folder / "live.csv").read_text()
        assert live.startswith("id,number,probability,readings,time\n") and len(live.splitlines()) > 1, live

        nothing = folder / "nothing"
        nothing.mkdir()
        said = run("track", "numbered.mp4", "--numbers", "none.csv", "-q", code=1, models=nothing)
        assert "script/model --numbers" in said and "marey-models" in said and len(said.splitlines()) == 1, said
        assert not (folder / "none.csv").exists()
        said = run("live", "play:numbered.mp4", "--numbers", "none.csv", "-q", code=2)
        assert "--targets people" in said, said
        said = run("live", "sim://room?cameras=2&blobs", "--targets", "people", "--numbers", "none.csv", "--duration", 1, "-q", code=1)
        assert "one camera's image or on the ground" in said, said


if __name__ == "__main__":
    main()

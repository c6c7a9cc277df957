"""The network for shirt numbers in OpenCV, as script/model --numbers rewrites it, against the published file in ONNX Runtime, on the same crops: every
probability agrees to 1e-4.

    numbers_test.py SHIRT_DIGITS MODELS    exits 77 (skipped) where script/model --numbers has not run, pip has no network, or ONNX Runtime is not installed
"""

import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
CROP, OUTPUT = (48, 96, 3), (12, 6625)
TOLERANCE = 1e-4


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


try:
    import numpy as np
    import onnxruntime
except ImportError as missing:
    skip(f"{missing.name} is not installed")


def published(folder):
    """The network as its makers published it: out of PyPI's package, as script/model fetches and checks it."""
    text = (ROOT / "script/model").read_text()
    package = re.search(r"rapidocr-onnxruntime==[\d.]+", text)[0]
    try:
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", folder, package], check=True, capture_output=True, timeout=180)
    except (OSError, subprocess.SubprocessError) as failed:
        skip(f"pip cannot fetch {package} ({failed})")
    with zipfile.ZipFile(next(pathlib.Path(folder).glob("*.whl"))) as wheel:
        file = pathlib.Path(wheel.extract("rapidocr_onnxruntime/models/ch_PP-OCRv4_rec_infer.onnx", folder))
    assert hashlib.sha256(file.read_bytes()).hexdigest() in text, f"{file} is another file than script/model converts"
    return file


def crops():
    """Noise, plain colours and digits of a few strokes."""
    random = np.random.default_rng(7)
    made = [random.integers(0, 256, CROP, np.uint8), np.full(CROP, 255, np.uint8)]
    for lines in (((8, 40, 30, 36), (8, 40, 60, 66)), ((8, 14, 30, 60), (8, 40, 55, 61)), ((20, 28, 20, 70),)):
        one = np.full(CROP, (60, 40, 150), np.uint8) + random.integers(0, 20, CROP, np.uint8)
        for top, bottom, left, right in lines:
            one[top:bottom, left:right] = 240
        made.append(one)
    return np.stack(made)


def main():
    program, models = sys.argv[1:3]
    converted = pathlib.Path(models, "shirt_numbers.onnx")
    if not converted.is_file():
        skip("script/model --numbers has not made the network")
    shown = crops()
    with tempfile.TemporaryDirectory() as folder:
        session = onnxruntime.InferenceSession(str(published(folder)))
        pathlib.Path(folder, "crops.bin").write_bytes(shown.tobytes())
        subprocess.run([program, converted, f"{folder}/crops.bin", f"{folder}/output.bin"], check=True)
        own = np.fromfile(f"{folder}/output.bin", np.float32).reshape(len(shown), *OUTPUT)
        for crop, output in zip(shown, own, strict=True):
            blob = crop.transpose(2, 0, 1)[None].astype(np.float32) / 127.5 - 1
            worst = np.abs(session.run(None, {session.get_inputs()[0].name: blob})[0][0] - output).max()
            assert worst < TOLERANCE, f"{worst} from ONNX Runtime"
            print(f"largest difference {worst:.1e}")
        other = subprocess.run([program, pathlib.Path(models, "person.onnx"), f"{folder}/crops.bin", f"{folder}/output.bin"], capture_output=True, text=True)
        assert other.returncode == 1 and "script/model --numbers" in other.stderr, other.stderr


if __name__ == "__main__":
    main()

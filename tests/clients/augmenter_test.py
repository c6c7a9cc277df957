"""OpenCap's marker augmenter as Marey computes it, against the published files in ONNX Runtime, on the same sequences: every output agrees to 1e-5.

    augmenter_test.py AUGMENTED_MARKERS MODELS    exits 77 (skipped) where script/model --augmenter has not run, pip has no network, or ONNX Runtime is not
                                                  installed
"""

import hashlib
import pathlib
import re
import subprocess
import sys
import tempfile
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
STEPS, SEQUENCES = 400, 2
TOLERANCE = 1e-5


def skip(why):
    print(f"skipped: {why}")
    sys.exit(77)


try:
    import numpy as np
    import onnxruntime
except ImportError as missing:
    skip(f"{missing.name} is not installed")


def published(folder):
    """The networks as their makers published them: out of PyPI's package, as script/model fetches and checks it."""
    text = (ROOT / "script/model").read_text()
    package = re.search(r"pose2sim==[\d.]+", text)[0]
    try:
        subprocess.run([sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", folder, package], check=True, capture_output=True, timeout=180)
    except (OSError, subprocess.SubprocessError) as failed:
        skip(f"pip cannot fetch {package} ({failed})")
    with zipfile.ZipFile(next(pathlib.Path(folder).glob("*.whl"))) as wheel:
        for part in ("lower", "upper"):
            files = [pathlib.Path(wheel.extract(f"Pose2Sim/MarkerAugmenter/LSTM/v0.3_{part}/{name}", folder)) for name in ("model.onnx", "mean.npy", "std.npy")]
            assert hashlib.sha256(files[0].read_bytes()).hexdigest() in text, f"{files[0]} is another file than script/model converts"
            yield part, *files


def sequences(mean, spread):
    """Features that move slowly about their mean, as a person's do; "std.npy" holds variances."""
    random = np.random.default_rng(7)
    steps = random.normal(size=(SEQUENCES, STEPS, mean.size))
    for t in range(1, STEPS):
        steps[:, t] = 0.95 * steps[:, t - 1] + np.sqrt(1 - 0.95**2) * steps[:, t]
    return mean + np.sqrt(spread) * steps


def main():
    program, models = sys.argv[1:3]
    if not pathlib.Path(models, "augmenter_lower.onnx").is_file():
        skip("script/model --augmenter has not made the networks")
    with tempfile.TemporaryDirectory() as folder:
        for part, model, mean_file, spread_file in published(folder):
            mean, spread = np.load(mean_file), np.load(spread_file)
            inputs = sequences(mean, spread)
            session = onnxruntime.InferenceSession(str(model))
            expected = np.concatenate([session.run(None, {"inputs": one[None].astype(np.float32)})[0] for one in (inputs - mean) / spread])
            pathlib.Path(folder, "inputs.bin").write_bytes(inputs.transpose(1, 0, 2).astype(np.float32).tobytes())
            subprocess.run([program, f"{models}/augmenter_{part}.onnx", f"{folder}/inputs.bin", f"{folder}/outputs.bin", str(SEQUENCES)], check=True)
            own = np.fromfile(f"{folder}/outputs.bin", np.float32).reshape(STEPS, SEQUENCES, -1).transpose(1, 0, 2)
            worst = np.abs(own - expected).max()
            print(f"{part}: largest difference {worst:.1e} of heights up to {np.abs(expected).max():.2f}")
            assert worst < TOLERANCE, f"{part}: {worst} from ONNX Runtime"
        pathlib.Path(folder, "cut.onnx").write_bytes(pathlib.Path(models, "augmenter_lower.onnx").read_bytes()[:-1000])
        for other in (f"{folder}/cut.onnx", f"{models}/person.onnx"):
            assert subprocess.run([program, other, f"{folder}/inputs.bin", f"{folder}/outputs.bin", "1"], capture_output=True).returncode == 1, other


if __name__ == "__main__":
    main()

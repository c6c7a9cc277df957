"""Every option of every job gives the same bytes from Python as from the command line: alone, and with each option that it depends on.

The cases are made from the descriptions of the jobs (src/marey/pipeline/jobs), so that an option without an example fails here.

Usage: same_bytes_test.py MAREY ROOT [unittest options].
"""

import pathlib
import re
import subprocess
import tempfile
import unittest
import warnings

from simulated_video import MAREY, ROOT, command, np

import marey
from marey import _core

MODELS = ROOT / "build" / "models"
HOLDER = tempfile.TemporaryDirectory(prefix="marey_same_")
FOLDER = pathlib.Path(HOLDER.name)

# A value of each option that is neither a flag nor a choice: as Python takes it. A function gets the folder for outputs.
EXAMPLES = {
    "track people": {
        "detections": "boxes.txt",
        "rate": 20,
        "overlay": lambda out: out / "overlay.mp4",
        "copy": lambda out: out / "copy.mp4",
        "plot": lambda out: out / "plot.svg",
        "foreground-masks": lambda out: out / "masks",
        "target-masks": lambda out: out / "target_masks",
        "numbers": lambda out: out / "numbers.csv",
        "contour-model": "lite",
        "lag": 0.5,
        "detector": MODELS / "person.toml",
        "detector-interval": 3,
        "control-points": 12,
        "spline-order": 3,
        "measurement-lines": 16,
        "model": "lite",
    },
    "track markers": {
        "detections": "blobs.csv",
        "rate": 20,
        "overlay": lambda out: out / "overlay.mp4",
        "plot": lambda out: out / "plot.svg",
        "labels": "labels.txt",
        "threshold": 60.5,
        "max-width": 30,
        "max-markers": 4,
        "min-area": 5,
        "max-area": 900,
        "min-roundness": 0.5,
        "colour": "120+-30",
        "saturation": 0.25,
        "mask": "mask.png",
        "auto-mask": 0.2,
    },
    "track ground": {
        "rate": 20,
        "overlay": lambda out: out / "overlays",
        "copy": lambda out: out / "copies",
        "numbers": lambda out: out / "numbers.csv",
        "pitch-view": lambda out: out / "view.mp4",
        "detector": MODELS / "person.toml",
        "detector-interval": 3,
        "size": (100, 60),
        "area": [(10, 5), (90, 5), (50, 60)],
        "margin": 1.5,
        "teams": "white,blue",
    },
}
EXAMPLES["reconstruct markers"] = {
    "labels": "room_labels.txt",
    "rate": 80,
    "noise": 0.5,
    "max-gap": 0.1,
    "max-prediction": 0.05,
    "marker-diameter": 0.02,
    "max-speed": 4,
    "threshold": 60,
    "max-width": 20,
    "max-markers": 6,
    "min-area": 4,
    "max-area": 500,
    "min-roundness": 0.5,
    "marker-set": "set.toml",
    "skeleton": "skeleton.toml",
}
EXAMPLES["reconstruct keypoints"] = {
    "rate": 20,
    "keypoint-set": "body_25",
    "people": 1,
    "max-offset": 0.1,
    "model": "lite",
    "detector": MODELS / "person.toml",
    "detector-interval": 3,
}
EXAMPLES["solve"] = {
    "skeleton": "person.toml",
    "static-trial": "blobs.csv",
    "marker-set": "cmu-41",
    "rom-trial": "blobs.csv",
    "person": "P1",
    "write-skeleton": lambda out: out / "used.toml",
    "exclude": "P1:left_ankle",
    "unit": 0.0254,
    "bvh-unit": 1,
    "rig-names": "mixamo",
    "calibration-take": "blobs.csv",
    "mass": 70,
}
EXAMPLES["augment"] = {"height": 1.75, "mass": 70, "angles": lambda out: out / "angles.csv", "person": "P1"}
EXAMPLES["track keypoints"] = EXAMPLES["track people"]
# What an option needs to have an effect or to be taken, beyond what its row declares.
WITH = {"blur": ["overlay"], "foreground-masks": ["background"], "detector-interval": ["detector"], "no-background": ["detector"]}
# Options whose network is made by script/model, which not every machine has.
MODEL_OPTIONS = {"detector", "detector-interval", "no-background", "model", "contour-model"}


def shell_words(options):
    """As a user types them."""
    for name, value in options.items():
        if value is True:
            yield f"--{name}"
        elif isinstance(value, tuple):
            yield from (f"--{name}", f"{value[0]}x{value[1]}")
        elif isinstance(value, list):
            yield from (f"--{name}", " ".join(f"{x},{y}" for x, y in value))
        else:
            yield from (f"--{name}", str(value))


def content(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*")) if path.is_file()}


def as_text(take):
    """A take is committed once a second while it grows, so that a busy machine divides its rows otherwise: what it holds, then."""
    path = FOLDER / "take.marey"
    path.write_bytes(take)
    recording = marey.read(path)
    text = FOLDER / ("take.jsonl" if recording.frame == "image" else "take.csv")
    recording.write(text)
    return text.read_text(), recording.made_by


class SameBytes(unittest.TestCase):
    maxDiff = 400
    also = ()  # names of further outputs

    @classmethod
    def setUpClass(cls):
        cls.addClassCleanup(HOLDER.cleanup)
        warnings.simplefilter("ignore", marey.Warning)
        command("simulate", "people", "--situation", "crowd", "--people", 3, "--frames", 30, "--seed", 4, "-o", "people", "-q", cwd=FOLDER)
        command("simulate", "markers", "plain", "--frames", 40, "-o", "markers", "-q", cwd=FOLDER)
        command("simulate", "match", "-o", "match", "--cameras", 3, "--seconds", 4, "--boxes", "-q", cwd=FOLDER)
        command("track", "people/video.mp4", "-o", "boxes.txt", "-q", cwd=FOLDER)
        film = next((FOLDER / "markers").glob("*.mp4")).rename(FOLDER / "markers.mp4")
        command("detect", film, "-o", "blobs.csv", "-q", cwd=FOLDER)
        found = marey.track(film, targets="markers")
        (FOLDER / "labels.txt").write_text("".join(f"name{i}\n" for i in range(len(found.tracks))))
        cls.write_mask(film)

    @classmethod
    def write_mask(cls, film):
        import cv2

        size = cv2.VideoCapture(str(film)).read()[1].shape[:2]
        mask = np.zeros(size, np.uint8)
        mask[: size[0] // 4] = 255
        cv2.imwrite(str(FOLDER / "mask.png"), mask)

    def both(self, name, options, words, run):
        """The files that the command line and Python make with these options; what they say where they refuse them."""
        results = []
        for front_end in ("shell", "python"):
            out = FOLDER / name / front_end
            out.mkdir(parents=True)
            given = {option: value(out) if callable(value) else FOLDER / value if (FOLDER / str(value)).is_file() else value
                     for option, value in options.items()}
            try:
                if front_end == "shell":
                    self.shell(*words(given), *shell_words(given), *(f"--output={out / name}" for name in ("tracks.marey", *self.also)), "-q")
                else:
                    run({option.replace("-", "_"): value for option, value in given.items()}, [out / name for name in ("tracks.marey", *self.also)])
                results.append(content(out))
            except marey.Error as error:
                results.append(re.sub(r"--([a-z-]+)", lambda found: found[1].replace("-", "_"), str(error)).replace(str(out), "OUT"))
        return results

    def shell(self, *words):
        done = subprocess.run([MAREY, *map(str, words)], cwd=FOLDER, capture_output=True, text=True, timeout=300)
        if done.returncode:
            raise marey.Error(done.stderr.strip().splitlines()[-1].removeprefix("marey: "))

    def cases(self, job, apart=()):
        """apart: options that are compared in another job, whose code is the same."""
        rows = {row["name"]: row for row in _core.job_options(job)}

        def value_of(name):
            row = rows[name]
            if row["kind"] == "flag":
                return True
            if row["choices"]:
                return next(choice for choice in reversed(row["choices"]) if choice not in (row["default"], "bramble"))
            self.assertIn(name, EXAMPLES[job], f"the option {name} of {job} has no example in this test")
            return EXAMPLES[job][name]

        def with_needs(*names):
            needed = [rows[name]["needs"] for name in names if rows[name]["needs"] in rows]
            return {name: value_of(name) for name in dict.fromkeys([*names, *needed])}

        yield "nothing", {}
        for name, row in rows.items():
            if name in apart:
                continue
            yield name, with_needs(name)
            for choice in row["choices"]:
                if choice not in (value_of(name), "bramble"):
                    yield f"{name}_{choice}", {name: choice}
            for other in dict.fromkeys([*row["depends"], *WITH.get(name, [])]):
                yield f"{name}_and_{other}", with_needs(name, other)

    def check(self, job, words, run, apart=()):
        compared = refused = 0
        for name, options in self.cases(job, apart):
            if MODEL_OPTIONS & set(options) and not (MODELS / "person.toml").is_file():
                print(f"{job}: {name} is not compared: script/model makes the networks")
                continue
            with self.subTest(job=job, case=name):
                shell, python = self.both(f"{job}_{name}", options, words, run)
                self.assertIs(type(python), type(shell), (shell, python) if isinstance(shell, str) or isinstance(python, str) else None)
                if isinstance(shell, str):
                    self.assertEqual(python, shell)
                    refused += 1
                    continue
                self.assertEqual(sorted(python), sorted(shell))
                for path in shell:
                    if path == "tracks.marey" and python[path] != shell[path]:
                        self.assertEqual(as_text(python[path]), as_text(shell[path]))
                    else:
                        self.assertTrue(python[path] == shell[path], f"{path} differs")
                compared += 1
        print(f"{job}: {compared} cases with the same bytes, {refused} refused alike")
        self.assertGreater(compared, refused)

    def in_image(self, job, film, apart=()):
        targets = job.split()[1]

        def words(given):
            return ["track", *([] if "detections" in given else [film]), "--targets", targets]

        self.check(job, words, lambda given, sinks: marey.track(None if "detections" in given else film, targets=targets, sinks=sinks, **given), apart)

    def test_people(self):
        self.in_image("track people", FOLDER / "people" / "video.mp4")

    def test_keypoints(self):
        if not (MODELS / "pose_landmark_lite.onnx").is_file():
            self.skipTest("script/model makes the networks")
        apart = {row["name"] for row in _core.job_options("track people")} - {"every", "live", "without-background"}
        self.in_image("track keypoints", FOLDER / "people" / "video.mp4", apart)

    def test_markers(self):
        self.in_image("track markers", FOLDER / "markers.mp4")

    def test_ground(self):
        rig = FOLDER / "match" / "rig.toml"
        self.check("track ground", lambda given: ["track", rig, "--ground"], lambda given, sinks: marey.track_ground(rig, sinks=sinks, **given))

    def test_reconstruct_markers(self):
        room = ("simulate", "room", "--cameras", 3, "--markers", 12, "--frames", 40, "--size", 640, 512, "--render", "-o", "room", "-q")
        command(*room, cwd=FOLDER)
        command("label", "learn", "room/truth.csv", "-o", "set.toml", "-q", cwd=FOLDER)
        (FOLDER / "room_labels.txt").write_text("".join(f"name{i}\n" for i in range(12)))
        (FOLDER / "skeleton.toml").write_bytes((FOLDER / "room" / "skeleton.toml").read_bytes())
        rig = FOLDER / "room" / "rig.toml"
        self.check("reconstruct markers", lambda given: ["reconstruct", rig], lambda given, sinks: marey.reconstruct(rig, sinks=sinks, **given))

    def test_reconstruct_keypoints(self):
        room = ("simulate", "room", "--keypoints", "--cameras", 3, "--markers", 4, "--frames", 60, "--rate", 50, "-o", "keypoints", "-q")
        command(*room, cwd=FOLDER)
        rig = FOLDER / "keypoints" / "rig.toml"
        files = {camera.name: FOLDER / "keypoints" / f"keypoints_{camera.name}.json" for camera in marey.read_rig(rig).cameras}
        pairs = [f"{camera}={path}" for camera, path in files.items()]
        self.check(
            "reconstruct keypoints",
            lambda given: ["reconstruct", rig, *pairs, "--targets", "keypoints"],
            lambda given, sinks: marey.reconstruct(rig, targets="keypoints", sources=files, sinks=sinks, **given),
        )

    def test_solve(self):
        room = ("simulate", "room", "--motion", "walk", "--keypoints", "--cameras", 3, "--frames", 40, "--size", 1080, 1920, "-o", "dancer", "-q")
        command(*room, cwd=FOLDER)
        rig = FOLDER / "dancer" / "rig.toml"
        files = {camera.name: FOLDER / "dancer" / f"keypoints_{camera.name}.json" for camera in marey.read_rig(rig).cameras}
        dance = FOLDER / "dance.marey"
        marey.reconstruct(rig, targets="keypoints", sources=files, sinks=[dance])
        command("solve", dance, "-o", FOLDER / "dance.mot", "--write-skeleton", FOLDER / "person.toml", "-q", cwd=FOLDER)
        self.also = ("motion.bvh",)
        self.check("solve", lambda given: ["solve", dance], lambda given, outputs: marey.solve(dance, outputs=outputs, **given))
        summary = marey.solve(dance, outputs=[FOLDER / "twice.mot"], exclude=["P1:left_ankle", "P1:right_ankle"])
        self.assertEqual(summary["frames"], 40)
        self.assertLess(summary["rms_mm"], 60)

    def test_augment(self):
        if not (MODELS / "augmenter_lower.onnx").is_file():
            self.skipTest("script/model --augmenter has not made the networks")
        room = ("simulate", "room", "--motion", "walk", "--keypoints", "--cameras", 4, "--frames", 60, "--size", 1080, 1920, "--rate", 60, "-o", "walker", "-q")
        command(*room, cwd=FOLDER)
        rig = FOLDER / "walker" / "rig.toml"
        files = {camera.name: FOLDER / "walker" / f"keypoints_{camera.name}.json" for camera in marey.read_rig(rig).cameras}
        walk = FOLDER / "walk.marey"
        marey.reconstruct(rig, targets="keypoints", sources=files, sinks=[walk])
        self.also = ("markers.trc",)
        # The networks take a height and a mass always.
        self.check(
            "augment",
            lambda given: ["augment", walk, *(word for name in ("height", "mass") if name not in given for word in (f"--{name}", EXAMPLES["augment"][name]))],
            lambda given, sinks: marey.augment(walk, sinks=sinks, **{"height": 1.75, "mass": 70, **given}),
        )
        with self.assertRaisesRegex(marey.Error, "^height: is wanted"):
            marey.augment(walk, mass=70)
        instants = []
        made = marey.augment(walk, height=1.75, mass=70, sinks=[instants.append])
        self.assertEqual((len(made.tracks), len(instants)), (43, 60))
        low, high, deviation = made.summary["angles"]["left_knee_flexion"]
        self.assertTrue(low < high and 0 < deviation < 0.3, (low, high, deviation))

    def test_every_job_is_here(self):
        tested = {"track people", "track keypoints", "track markers", "track ground", "reconstruct markers", "reconstruct keypoints", "solve", "augment", "live"}
        tested |= {"batch plan", "batch run", "batch submit"}  # of the command line alone
        self.assertEqual(set(_core.job_names()), tested)


if __name__ == "__main__":
    unittest.main(verbosity=1)

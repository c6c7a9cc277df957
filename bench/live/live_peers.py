#!/usr/bin/env python3
"""`marey track --live` beside SORT, ByteTrack, OC-SORT and BoT-SORT (PyPI `trackers`) on the same boxes of weak detectors.

Usage: live_peers.py MAREY DATA [--options="--lag 0.5"] [--work FOLDER] [--scenes tud|pets|all] [--no-peers]

DATA is the folder that tests call MAREY_DATA: the boxes of a Faster R-CNN over tud/'s two videos, and the truth of
pets2009/ through the simulated detector of weak_detector.py, five seeds, 25 to 40 % missed. Peers run with their own
defaults at the recording's rate; without the package only Marey's lines are printed. All are evaluated by `marey evaluate`.
"""
import argparse
import collections
import json
import pathlib
import subprocess
import tempfile

import weak_detector

PEERS = {"SORT": "SORTTracker", "ByteTrack": "ByteTrackTracker", "OC-SORT": "OCSORTTracker", "BoT-SORT": "BoTSORTTracker"}
FIGURES = ("mota", "idf1", "hota")


def scenes(data, work, which):
    """(name, detections, truth, Hz)"""
    if which in ("tud", "all"):
        for film in ("TUD-Campus", "TUD-Stadtmitte"):
            folder = data / "tud" / film
            yield film, folder / "det_faster_rcnn.txt", folder / "gt.txt", 25.0
    if which in ("pets", "all"):
        truth = data / "pets2009" / "gt_001_300.txt"
        boxes = weak_detector.read(truth)
        for seed, missed in enumerate((0.25, 0.29, 0.33, 0.36, 0.40), 1):
            weak = work / f"pets_{seed}.txt"
            weak_detector.write(weak, weak_detector.weaken(boxes, seed, missed))
            yield f"PETS, {100 * missed:.0f} % missed", weak, truth, 7.0


def run_peer(peer, detections, rate, out, peers=PEERS):
    import numpy
    import supervision
    import trackers
    boxes = collections.defaultdict(list)
    for line in detections.read_text().splitlines():
        frame, _, left, top, width, height, score = map(float, line.split(",")[:7])
        boxes[int(frame)].append((left, top, left + width, top + height, score))
    more = {"enable_cmc": False} if peer == "BoT-SORT" else {}  # there are no images
    tracker = getattr(trackers, peers[peer])(frame_rate=rate, **more)
    with open(out, "w") as file:
        for frame in range(1, max(boxes) + 1):
            rows = numpy.array(boxes.get(frame, []), dtype=float).reshape(-1, 5)
            seen = supervision.Detections(xyxy=rows[:, :4].copy(), confidence=rows[:, 4].copy(),
                                          class_id=numpy.zeros(len(rows), dtype=int))
            found = tracker.update(seen)
            for (left, top, right, bottom), number in zip(found.xyxy, found.tracker_id):
                if number >= 0:
                    file.write(f"{frame},{number + 1},{left:.2f},{top:.2f},{right - left:.2f},{bottom - top:.2f},1,-1,-1,-1\n")


def evaluated(marey, truth, tracks):
    said = subprocess.run([marey, "evaluate", "--truth", truth, "--tracks", tracks, "--json"], capture_output=True, text=True,
                          check=True).stdout
    told = json.loads(said)
    return {name.lower(): value for name, value in flat(told) if name.lower() in (*FIGURES, "identity_switches", "switches")}


def flat(told):
    for name, value in told.items():
        if isinstance(value, dict):
            yield from flat(value)
        else:
            yield name, value


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--options", default="")
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--scenes", choices=("tud", "pets", "all"), default="all")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--offline", action="store_true", help="Marey without --live")
    given = parser.parse_args()
    work = given.work or pathlib.Path(tempfile.mkdtemp(prefix="marey_live_"))
    work.mkdir(exist_ok=True)
    try:
        import trackers  # noqa: F401
        peers = [] if given.no_peers else list(PEERS)
    except ImportError:
        peers = []
    means = collections.defaultdict(lambda: collections.defaultdict(list))
    for scene, detections, truth, rate in scenes(given.data, work, given.scenes):
        for method in [*peers, "Marey"]:
            out = work / f"{scene.split(',')[0]}_{method}.txt"
            if method == "Marey":
                subprocess.run([given.marey, "track", "--detections", detections, "--rate", str(rate), "-o", out, "-q",
                                *([] if given.offline else ["--live"]), *given.options.split()], check=True)
            else:
                run_peer(method, detections, rate, out)
            figures = evaluated(given.marey, truth, out)
            print(f"{scene:24} {method:10}", *(f"{name} {value:6.3f}" for name, value in figures.items()))
            for name in FIGURES:
                means[scene.split(",")[0]][method].append([figures[n] for n in FIGURES])
                break
    for scene, methods in means.items():
        for method, rows in methods.items():
            mean = [sum(column) / len(rows) for column in zip(*rows)]
            print(f"mean {scene:19} {method:10}", *(f"{name} {value:6.3f}" for name, value in zip(FIGURES, mean)))


if __name__ == "__main__":
    main()

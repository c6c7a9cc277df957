#!/usr/bin/env python3
"""`marey track --detections`, live and offline, beside five trackers of PyPI's `trackers` on simulated boxes.

Usage: box_peers.py MAREY [--seeds N] [--scenes TEXT] [--kinds true,weak] [--work FOLDER] [--no-peers] [--options="..."]

The scenes are those of box_scenes.py: streets and athletes before static cameras, pan, zoom, roll and shake. Boxes are the
truth's, or those of weak_detector.py: 30 % missed in runs, 10 % false, 8 % noise. Peers run with their own defaults at the
scene's rate; "filled" is the same with gaps of up to a second filled on a straight line, which offline is compared with. All are
evaluated by `marey evaluate`. A line is MOTA, IDF1, HOTA and frames a second.
"""
import argparse
import collections
import concurrent.futures
import pathlib
import subprocess
import sys
import tempfile
import time

import box_scenes
import live_peers
import weak_detector

PEERS = {**live_peers.PEERS, "C-BIoU": "CBIoUTracker"}


def fill(tracks, out, longest):
    """The rows between two of one number, at most `longest` frames apart, on a straight line."""
    rows = collections.defaultdict(dict)
    for line in tracks.read_text().splitlines():
        frame, number, *box = map(float, line.split(",")[:6])
        rows[int(number)][int(frame)] = box
    with open(out, "w") as file:
        for number, known in rows.items():
            frames = sorted(known)
            for before, after in zip(frames, frames[1:] + [None]):
                file.write(f"{before},{number},{','.join(f'{v:.2f}' for v in known[before])},1,-1,-1,-1\n")
                if after is None or after - before > longest:
                    continue
                for frame in range(before + 1, after):
                    share = (frame - before) / (after - before)
                    box = [a + share * (b - a) for a, b in zip(known[before], known[after])]
                    file.write(f"{frame},{number},{','.join(f'{v:.2f}' for v in box)},1,-1,-1,-1\n")


def methods_of(given, work, name, detections, rate, frames):
    """(method, file, frames/s)"""
    for peer in [] if given.no_peers else PEERS:
        out, filled = work / f"{name}_{peer}.txt", work / f"{name}_{peer}_filled.txt"
        if not filled.exists():
            begin = time.perf_counter()
            live_peers.run_peer(peer, detections, rate, out, PEERS)
            (work / f"{name}_{peer}.speed").write_text(str(frames / (time.perf_counter() - begin)))
            fill(out, filled, rate)
        speed = float((work / f"{name}_{peer}.speed").read_text())
        yield peer, out, speed
        yield f"{peer}, filled", filled, speed
    for method, more in (("live", ["--live"]), ("offline", [])):
        out = work / f"{name}_{method}.txt"
        begin = time.perf_counter()
        subprocess.run([given.marey, "track", "--detections", detections, "--rate", str(rate), "-o", out, "-q", *more,
                        *given.options.split()], check=True, stderr=subprocess.DEVNULL)
        yield method, out, frames / (time.perf_counter() - begin)


def run_scene(given, work, scene, seed, kind):
    boxes = box_scenes.truth(scene, seed)
    name = f"{scene.name.replace(', ', '_').replace(' ', '_')}_{seed}_{kind}"
    truth, detections = work / f"{name}.gt.txt", work / f"{name}.boxes.txt"
    box_scenes.write_truth(truth, boxes)
    seen = box_scenes.with_sure_scores(boxes) if kind == "true" else weak_detector.weaken(boxes, seed, rate=scene.rate)
    weak_detector.write(detections, seen)
    result = {}
    for method, tracks, speed in methods_of(given, work, name, detections, scene.rate, len(boxes)):
        figures = live_peers.evaluated(given.marey, truth, tracks)
        result[method] = (*(figures[n] for n in live_peers.FIGURES), speed)
    return scene.name, kind, result


def mean(rows):
    return [sum(column) / len(rows) for column in zip(*rows)]


def report(results):
    for kind in dict.fromkeys(kind for _, kind, _ in results):
        groups = collections.defaultdict(lambda: collections.defaultdict(list))
        for scene, its_kind, result in results:
            if its_kind != kind:
                continue
            for method, row in result.items():
                for group in (scene, "all athletes" if "street" not in scene else "all streets"):
                    groups[group][method].append(row)
        for group in sorted(groups, key=lambda g: g.startswith("all")):
            means = {method: mean(rows) for method, rows in groups[group].items()}
            line = [f"{kind:5} {group:34}"]
            for filled in (False, True):
                peers = [m for m in means if m.split(",")[0] in PEERS and m.endswith("filled") == filled]
                if peers:
                    line.append("best peer%s" % (", filled" if filled else ""))
                    line += [f"{100 * max(means[p][i] for p in peers):5.1f}" for i in range(3)]
                line.append("| live" if not filled else "| offline")
                line += [f"{100 * v:5.1f}" for v in means["offline" if filled else "live"][:3]]
                line.append("|")
            if group.startswith("all"):
                line.append(" ".join(f"{m} {means[m][3]:.0f}/s" for m in means if "filled" not in m))
            print(*line)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey", type=pathlib.Path)
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--scenes", default="", help="those whose name contains this")
    parser.add_argument("--kinds", default="true,weak")
    parser.add_argument("--work", type=pathlib.Path, help="results of the peers found there are used again")
    parser.add_argument("--no-peers", action="store_true")
    parser.add_argument("--options", default="")
    parser.add_argument("--threads", type=int, default=1)
    given = parser.parse_args()
    work = given.work or pathlib.Path(tempfile.mkdtemp(prefix="marey_boxes_"))
    work.mkdir(exist_ok=True)
    if not given.no_peers:
        try:
            import trackers  # noqa: F401
        except ImportError:
            sys.exit("PyPI's trackers==2.6.1 is not installed here; --no-peers prints Marey's lines alone")
    jobs = [(given, work, scene, seed, kind) for kind in given.kinds.split(",") for scene in box_scenes.SCENES
            if given.scenes in scene.name for seed in range(1, given.seeds + 1)]
    with concurrent.futures.ProcessPoolExecutor(given.threads) as pool:
        report(list(pool.map(run_scene, *zip(*jobs))))


if __name__ == "__main__":
    main()

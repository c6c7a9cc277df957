"""What may happen to a recording that changes no person in it: how its images or boxes change, and how its truth does.

A perturbation keeps some frames, in some order (`frames`), at a rate, and changes places by x -> across(x); videos besides by a
filter of FFmpeg and a quality. Videos are kept lossless where nothing is said of quality.
"""
import dataclasses
import random
import subprocess
import typing


@dataclasses.dataclass(frozen=True)
class Perturbation:
    name: str
    frames: typing.Callable = lambda count: range(count)  # of the 0-based frames of the recording, those shown, in order
    rate: float = 1.0      # of the frames shown, over the recording's
    scale: float = 1.0
    mirrored: bool = False
    filter: str = ""       # of FFmpeg
    crf: int | None = None
    box_noise: float = 0.0  # recordings of boxes: of the height, on each side
    box_missed: float = 0.0  # and share of boxes omitted


def dropped(share, seed):
    """Frames are lost, at unknown times: those left follow one another evenly."""
    def keep(count):
        draw = random.Random(seed)
        return [i for i in range(count) if i == 0 or draw.random() >= share]
    return keep


def later(start):
    return lambda count: range(start, count)


def levels(gain):
    return f"lutyuv=y='clip((val-16)*{gain}+16,16,235)':u='(val-128)*{gain}+128':v='(val-128)*{gain}+128'"


TIME = [
    Perturbation("mirrored", mirrored=True),
    Perturbation("reversed", frames=lambda count: range(count - 1, -1, -1)),
    Perturbation("5 % dropped", frames=dropped(0.05, 1)),
    Perturbation("10 % dropped", frames=dropped(0.1, 2)),
    Perturbation("from frame 21", frames=later(20)),
    Perturbation("from frame 71", frames=later(70)),
]
VIDEOS = [
    Perturbation("as it is"),
    *TIME,
    Perturbation("crf 18", crf=18),
    Perturbation("crf 23", crf=23),
    Perturbation("crf 28", crf=28),
    Perturbation("crf 28, mirrored", crf=28, mirrored=True),
    Perturbation("scale 0.5", scale=0.5),
    Perturbation("scale 0.75", scale=0.75),
    Perturbation("scale 1.25", scale=1.25),
    Perturbation("scale 1.5", scale=1.5),
    Perturbation("10 % brighter", filter=levels(1.1)),
    Perturbation("10 % darker", filter=levels(0.9)),
    Perturbation("noise of 4 levels", filter="noise=alls=14:allf=t:all_seed=1"),
    Perturbation("every second frame", frames=lambda count: range(0, count, 2), rate=0.5),
    Perturbation("reversed, crf 23", frames=lambda count: range(count - 1, -1, -1), crf=23),
]
BOXES = [
    Perturbation("as it is"),
    *TIME,
    Perturbation("noise of 3 %", box_noise=0.03),
    Perturbation("noise of 6 %", box_noise=0.06),
    Perturbation("10 % of boxes missed", box_missed=0.1),
    Perturbation("20 % of boxes missed", box_missed=0.2),
    Perturbation("every second frame", frames=lambda count: range(0, count, 2), rate=0.5),
]


def read(path):
    """{frame: [fields]}, frames and pixels from 1 as MOT text counts."""
    rows = {}
    for line in path.read_text().splitlines():
        fields = line.split(",")
        rows.setdefault(int(float(fields[0])), []).append([float(field) for field in fields[1:7]])
    return rows


def perturbed_rows(rows, perturbation, count, width, noisy=False):
    """Rows of the frames shown, numbered again. `width` of the image, px. Noise and misses are for detections alone."""
    draw = random.Random(7)
    lines = []
    for number, frame in enumerate(perturbation.frames(count), 1):
        for who, left, top, across, down, score in rows.get(frame + 1, []):
            if noisy and draw.random() < perturbation.box_missed:
                continue
            if noisy and perturbation.box_noise:
                sides = [draw.gauss(0, perturbation.box_noise * down) for _ in range(4)]
                left, top, across, down = left + sides[0], top + sides[1], across + sides[2] - sides[0], down + sides[3] - sides[1]
            if perturbation.mirrored:
                left = width + 2 - left - across  # pixels count from 1
            k = perturbation.scale
            lines.append(f"{number},{int(who)},{(left - 1) * k + 1:.3f},{(top - 1) * k + 1:.3f},{across * k:.3f},{down * k:.3f},{score},-1,-1,-1")
    return "\n".join(lines) + "\n"


def selection(chosen):
    """FFmpeg's expression for these frame numbers, in order: runs of them, added pairwise, as it nests only so deep."""
    runs = []
    for i in chosen:
        if runs and runs[-1][1] == i - 1:
            runs[-1][1] = i
        else:
            runs.append([i, i])
    terms = [f"between(n,{first},{last})" for first, last in runs]
    while len(terms) > 1:
        terms = ["(" + "+".join(terms[i:i + 8]) + ")" for i in range(0, len(terms), 8)]
    return terms[0]


def write_video(source, out, perturbation, count):
    """Plain frames are chosen by their numbers; what is reversed is turned round after that."""
    chosen = list(perturbation.frames(count))
    steps = []
    backwards = len(chosen) > 1 and chosen[0] > chosen[-1]
    steps.append(f"select='{selection(sorted(chosen))}'")
    if backwards:
        steps.append("reverse")
    if perturbation.mirrored:
        steps.append("hflip")
    if perturbation.scale != 1:
        steps.append(f"scale=trunc(iw*{perturbation.scale}/2)*2:trunc(ih*{perturbation.scale}/2)*2:flags=bicubic")
    if perturbation.filter:
        steps.append(perturbation.filter)
    steps.append("setpts=N/(10*TB)")
    quality = ["-qp", "0", "-preset", "ultrafast"] if perturbation.crf is None else ["-crf", str(perturbation.crf)]
    started = out.with_suffix(".part.mkv")
    subprocess.run(["ffmpeg", "-v", "error", "-y", "-i", source, "-vf", ",".join(steps), "-r", "10", "-an", "-frames:v", str(len(chosen)),
                    "-c:v", "libx264", "-threads", "1", "-pix_fmt", "yuv420p", *quality, started], check=True)
    started.rename(out)

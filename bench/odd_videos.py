#!/usr/bin/env python3
"""Videos that background subtraction is not made for, and what `marey track` says of each: a clip of a panning television camera, a music
video (cuts every one to three seconds), a screen recording with scrolling text, a time lapse, rain at night, and a security video of 8
frames a second, which is to work. Each must end in a warning that names the cause, or in at most one false track in ten seconds.

Usage: bench/odd_videos.py MAREY DATA [--folder FOLDER] [--only NAMES] [--live] [--make]. Needs FFmpeg's program, numpy, and Debian's opencv-doc.
"""

import argparse
import csv
import json
import pathlib
import random
import subprocess
import tempfile

import numpy as np

EXAMPLES = pathlib.Path("/usr/share/doc/opencv-doc/examples/data")


def ffmpeg(*arguments, **more):
    subprocess.run(["ffmpeg", "-v", "error", "-y", *map(str, arguments)], check=True, **more)


def encode(path, rate, images, quality=23):
    """Grey images, all of one size."""
    first = next(images)
    command = ["ffmpeg", "-v", "error", "-y", "-f", "rawvideo", "-pix_fmt", "gray", "-s", f"{first.shape[1]}x{first.shape[0]}", "-r", str(rate), "-i", "-",
               "-pix_fmt", "yuv420p", "-c:v", "libx264", "-preset", "veryfast", "-crf", str(quality), str(path)]
    writer = subprocess.Popen(command, stdin=subprocess.PIPE)
    writer.stdin.write(first.tobytes())
    for picture in images:
        writer.stdin.write(picture.tobytes())
    writer.stdin.close()
    assert writer.wait() == 0


def grey(path, size, seconds=None, filters=""):
    """A video's images, as an array."""
    more = ["-t", str(seconds)] if seconds else []
    raw = subprocess.run(["ffmpeg", "-v", "error", "-i", str(path), *more, "-vf", f"{filters}scale={size[0]}:{size[1]}", "-pix_fmt", "gray", "-f",
                          "rawvideo", "-"], capture_output=True, check=True).stdout
    return np.frombuffer(raw, np.uint8).reshape(-1, size[1], size[0])


def music(path, given):
    """Forty seconds of pieces of all clips there are, in any order."""
    clips = [EXAMPLES / "vtest.avi", EXAMPLES / "Megamind.avi", given.data / "clips/walk_in_room.mp4", given.data / "clips/road.avi",
             given.data / "turning_camera/clip.mp4"]
    draw, inputs, chain, at = random.Random(4), [], "", 0.0
    while at < 40:
        length = draw.uniform(1, 3)
        clip = draw.choice(clips)
        begin = draw.uniform(0, 3 if "turning" in str(clip) or "Megamind" in str(clip) else 9)
        inputs += ["-ss", f"{begin:.2f}", "-t", f"{length:.2f}", "-i", clip]
        number = len(inputs) // 6 - 1
        chain += f"[{number}:v]scale=640:360,setsar=1,fps=25[c{number}];"
        at += length
    count = len(inputs) // 6
    chain += "".join(f"[c{i}]" for i in range(count)) + f"concat=n={count}:v=1"
    ffmpeg(*inputs, "-filter_complex", chain, "-an", "-c:v", "libx264", "-preset", "veryfast", path)


def screen(path, given):
    """A window with text that is scrolled by leaps of the wheel, and a cursor."""
    draw = random.Random(2)
    words = ["tracking", "of", "a", "the", "camera", "measured", "in", "video", "people", "filter", "which", "noise", "and", "state"]
    text = given.folder / "text.txt"
    text.write_text("\n".join(" ".join(draw.choice(words) for _ in range(draw.randrange(4, 11))) if draw.random() > 0.15 else "" for _ in range(220)))
    leaps = "+".join(f"{draw.choice([90, 120, 150])}*clip((t-{when:.1f})*6,0,1)" for when in np.arange(1, 29, 0.9))
    ffmpeg("-f", "lavfi", "-i", "color=0xf4f4f4:size=1280x720:rate=30:duration=30", "-vf",
           f"drawtext=textfile={text}:fontfile=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf:fontsize=22:line_spacing=8:x=260:y='60-({leaps})',"
           "drawbox=0:0:1280:48:0x30343c:fill,drawbox=0:48:200:672:0xd8dce4:fill,"
           "drawtext=text='File  Edit  View  Window  Help':fontfile=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf:fontsize=20:fontcolor=white:x=20:y=14,"
           "drawtext=text='|':fontsize=26:fontfile=/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf:x='600+200*sin(t)':y='400+150*cos(1.3*t)'",
           "-c:v", "libx264", "-preset", "veryfast", "-pix_fmt", "yuv420p", path)


def lapse(path, given):
    """A simulated street, an image every five seconds, played at 25: 40 minutes in 20 seconds, while the light goes up and down."""
    street = given.folder / "street"
    if not (street / "video.mp4").exists():
        subprocess.run([given.marey, "simulate", "people", "-o", street, "--frames", "500", "--rate", "1", "--speed-factor", "5", "--people", "8", "--seed", "7", "-q"],
                       check=True)
    ffmpeg("-r", "25", "-i", street / "video.mp4", "-vf", "eq=brightness='0.12*sin(t*0.7)':eval=frame", "-c:v", "libx264", "-preset", "veryfast", path)


def lapse_of_street(path, given):
    """The real street, every twentieth image."""
    ffmpeg("-i", EXAMPLES / "vtest.avi", "-vf", "select='not(mod(n,20))',setpts=N/25/TB", "-r", "25", "-c:v", "libx264", path)


def rain(path, given):
    """The empty street at night, the camera's gain up, streaks of rain lit by its infrared lamp."""
    size = (768, 576)
    empty = np.median(grey(EXAMPLES / "vtest.avi", size, filters="select='not(mod(n,40))',setpts=N/TB,"), axis=0)
    random_of = np.random.default_rng(3)
    y, x = np.mgrid[0:size[1], 0:size[0]]
    lamp = np.exp(-((x - 384) ** 2 + (y - 330) ** 2) / 300.0**2)
    dark = 16 + empty * (0.08 + 0.3 * lamp)

    def images():
        for _ in range(15 * 20):
            picture = dark + random_of.normal(0, 5, dark.shape)
            for _ in range(45):
                length, width = random_of.integers(12, 110), random_of.integers(1, 4)
                left, top = random_of.integers(0, size[0] - 12), random_of.integers(-60, size[1])
                for i in range(0, length, 2):
                    row = top + i
                    if 0 <= row < size[1] - 1:
                        picture[row:row + 2, left + i // 12:left + i // 12 + width] += 25 + 70 * lamp[row, left]
            yield np.clip(picture, 0, 255).astype(np.uint8)

    encode(path, 15, images())


def security(path, given):
    """8 frames a second, grey, coded hard, a clock in the corner."""
    clock = "drawtext=text='CAM 03  %{pts\\:localtime\\:1700000000}':fontfile=/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf:fontsize=20:fontcolor=white:box=1:boxcolor=black@0.4:x=8:y=8"
    ffmpeg("-r", "8", "-i", EXAMPLES / "vtest.avi", "-vf", f"scale=704:528,hue=s=0,{clock}", "-c:v", "libx264", "-preset", "veryfast", "-crf", "33", path)


def empty_security(path, given):
    """The same street without any person, and noise."""
    size = (704, 528)
    empty = np.median(grey(EXAMPLES / "vtest.avi", size, filters="select='not(mod(n,40))',setpts=N/TB,"), axis=0)
    random_of = np.random.default_rng(3)
    still = given.folder / "empty_still.mp4"
    encode(still, 8, (np.clip(empty + random_of.normal(0, 6, empty.shape), 0, 255).astype(np.uint8) for _ in range(8 * 40)), 12)
    clock = "drawtext=text='CAM 03  %{pts\\:localtime\\:1700000000}':fontfile=/usr/share/fonts/truetype/dejavu/DejaVuSansMono.ttf:fontsize=20:fontcolor=white:box=1:boxcolor=black@0.4:x=8:y=8"
    ffmpeg("-i", still, "-vf", clock, "-c:v", "libx264", "-preset", "veryfast", "-crf", "33", path)


def zoom(path, given):
    """The street through a lens that zooms in for five seconds, after five in which it stands."""
    ffmpeg("-i", EXAMPLES / "vtest.avi", "-t", "20", "-vf",
           "setpts=N/10/TB,zoompan=z='1+0.5*clip((on-50)/50,0,1)':x='(iw-iw/zoom)/2':y='(ih-ih/zoom)/2':d=1:s=768x576:fps=10", "-c:v", "libx264",
           "-preset", "veryfast", path)


def late_pan(path, given):
    """The room, the camera turned after 40 s: what stands is 60 px aside afterwards."""
    ffmpeg("-i", given.data / "clips/walk_in_room.mp4", "-t", "70", "-vf", "crop=640:360:x='20+60*clip((t-40)/2,0,1)':y=30", "-c:v", "libx264", "-preset",
           "veryfast", path)


def panning(path, given):
    path.write_bytes((given.data / "turning_camera/clip.mp4").read_bytes())


VIDEOS = {"panning": panning, "zoom": zoom, "late_pan": late_pan, "music": music, "screen": screen, "lapse": lapse, "lapse_of_street": lapse_of_street,
          "rain": rain, "security": security, "empty_security": empty_security}
NO_PERSON = {"screen", "rain", "empty_security"}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("marey")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--folder", type=pathlib.Path, default=pathlib.Path(tempfile.gettempdir()) / "marey_odd")
    parser.add_argument("--only", default="")
    parser.add_argument("--make", action="store_true", help="make the videos and track nothing")
    parser.add_argument("--live", action="store_true")
    given = parser.parse_args()
    given.folder.mkdir(exist_ok=True)
    for name, make in VIDEOS.items():
        if given.only and name not in given.only.split(","):
            continue
        path = given.folder / f"{name}.mp4"
        if not path.exists():
            make(path, given)
        if given.make:
            continue
        rows = given.folder / f"{name}.csv"
        done = subprocess.run([given.marey, "track", path, "-o", rows, "--json", *(["--live"] if given.live else [])], capture_output=True, text=True)
        if done.returncode != 0:
            print(f"{name:16} {done.stderr.strip()}", flush=True)
            continue
        report = json.loads(done.stdout)
        with open(rows, encoding="utf-8") as file:
            at_once, people = {}, set()
            for row in csv.DictReader(file):
                people.add(row["id"])
                at_once[row["frame"]] = at_once.get(row["frame"], 0) + 1
        said = f"{len(people)} tracks, {max(at_once.values(), default=0)} at once, {report['seconds']:.1f} s"
        if name in NO_PERSON:
            said += f", {10 * len(people) / max(report['seconds'], 1):.1f} false in 10 s"
        print(f"{name:16} {said}", *(f"\n    warning: {warning}" for warning in report["warnings"]), *(f"\n    note: {note}" for note in report["notes"]), flush=True)


if __name__ == "__main__":
    main()

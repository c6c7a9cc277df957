"""Phones as cameras: two Chromium instances whose camera draws this machine's clock, in one live run.

    phones_test.py MAREY [FOLDER]      exits 77 (skipped) where Node, the page's packages or Chromium are not here

One that is turned, sleeps, changes its network or is opened twice follows. Clocks of phones are right when images that show the same time are given the same time; what a page could not send is counted as lost.
"""
import json
import os
import pathlib
import re
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import tomllib

import viewer_test

SECONDS = 12
LATE_MS = 1500  # half of the images are in the run's page by then, on a machine that does other things too
APART_MS = 20  # between the two clocks, on a machine that does other things too; measured on a free one: docs/live.md


def begun(command, folder):
    live = subprocess.Popen([str(part) for part in command], cwd=folder, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    found = {}
    for line in live.stderr:
        for what, text in (("phone", r"open (https://\S+) on each phone"), ("view", r"open (http://\S+) in a browser")):
            if match := re.search(text, line):
                found[what] = match[1]
        if len(found) == 2:
            return live, found
    raise AssertionError(f"{command} invites no phone: {live.wait()}")


def coded_ms(image):
    """The time that an image shows; None where it is not to be read."""
    import cv2

    grey = cv2.cvtColor(image, cv2.COLOR_BGR2GRAY) if image.ndim == 3 else image
    block = lambda column, row: float(grey[32 * row + 8 : 32 * row + 24, 32 * column + 8 : 32 * column + 24].mean())
    light, dark = block(1, 0), block(9, 0)
    if light - dark < 100:
        return None
    level = (light + dark) / 2
    return sum(1 << bit for bit in range(44) if block(bit % 11, 1 + bit // 11) > level)


def differences(video):
    """Of each frame: the time that it shows less the time that it has, ms."""
    import cv2

    found = []
    capture = cv2.VideoCapture(str(video))
    while True:
        there, image = capture.read()
        if not there:
            return found
        if (shown := coded_ms(image)) is not None:
            found.append(shown - capture.get(cv2.CAP_PROP_POS_MSEC))


def run(marey, folder, source, seconds, *cameras):
    """What the pages show at their end, and the summary of the live run that they were cameras of."""
    phones = [f"{name}=phone:{name}?port=0" for name in cameras]
    live, address = begun([marey, "live", *phones, "--view", "--port", "0", "-o", f"{source}.marey", "--record", "video", "--duration", "120", "--json"], folder)
    try:
        script = pathlib.Path(__file__).with_name("phones_browser.mjs")
        command = ["node", script, viewer_test.PAGE, address["phone"], str(seconds), source, *cameras]
        environment = os.environ | ({"MAREY_VIEW": address["view"]} if source == "canvas" else {})
        shown = json.loads(subprocess.run(command, check=True, timeout=200, capture_output=True, text=True, env=environment).stdout)
        pages = shown["pages"]
    finally:
        live.send_signal(signal.SIGINT)
    summary = json.loads(live.communicate(timeout=60)[0])
    for page in pages:
        assert not page["wrong"], page
        assert page["problem"].startswith(f"This phone is camera {page['camera']}"), page
        camera = summary["cameras"][page["camera"]]
        # What the page could not send has a number, too.
        omitted = int(re.search(r"(\d+) not sent", page["figures"])[1])
        print(page["camera"], page["figures"], camera)
        assert camera["frames"] > 3 * seconds and camera["lost"] >= 0.5 * omitted - 5, (page, camera)
    return shown["ages"]


def two_clocks(marey, folder):
    ages = run(marey, folder, "canvas", SECONDS, "left", "right")
    assert len(ages) > 3 * SECONDS, f"the page showed {len(ages)} images"
    quarters = statistics.quantiles(ages[len(ages) // 4 :], n=20)
    print(f"from a phone's camera to the run's page: {quarters[9]:.0f} ms, 95 % within {quarters[18]:.0f} ms ({len(ages)} images)")
    assert quarters[9] < LATE_MS, quarters
    apart = []
    for camera in tomllib.loads((folder / "canvas_video/rig.toml").read_text())["camera"]:
        apart.append(statistics.median(differences(folder / "canvas_video" / camera["source"])) - 1000 * camera["offset_s"])
    print(f"the two phones' clocks are {abs(apart[0] - apart[1]):.1f} ms apart")
    assert abs(apart[0] - apart[1]) < APART_MS, apart


def trouble(marey, folder):
    """The run continues, says what happened, and every image that the phone took is there or counted."""
    live, address = begun([marey, "live", "left=phone:left?port=0", "--view", "--port", "0", "-o", "trouble.marey", "--record", "video", "--duration", "300", "--json"], folder)
    said = []
    listens = threading.Thread(target=lambda: said.extend(live.stderr))
    listens.start()
    try:
        script = pathlib.Path(__file__).with_name("phones_trouble.mjs")
        done = subprocess.run(["node", script, viewer_test.PAGE, address["phone"], "left"], timeout=280, capture_output=True, text=True)
        assert done.returncode == 0, (done.stderr, said)
        pages = json.loads(done.stdout)
    finally:
        live.send_signal(signal.SIGINT)
        told = live.stdout.read()
        listens.join(timeout=60)
        live.wait(timeout=60)
    camera = json.loads(told)["cameras"]["left"]
    text = "".join(said)
    print(pages, camera)
    for sentence in ("phone left: was turned", "phone left: page is hidden", "phone left: another phone has taken its place"):
        assert sentence in text, (sentence, text)
    assert not any(page["wrong"] for page in pages), pages
    taken = sum(page["images"] for page in pages)
    counted = camera["frames"] + camera["lost"] + camera["damaged"]
    # The pages' counts are read a moment after a phone became the camera, and before it ended.
    assert abs(counted - taken) < 30, f"{taken} images were taken, {counted} are there or counted: {pages}, {camera}"
    assert camera["lost"] > 100 and camera["damaged"] == 0, camera


def camera_of_the_browser(marey, folder):
    run(marey, folder, "device", 4, "front")


def main():
    viewer_test.skip_where_absent()
    try:
        import cv2  # noqa: F401
    except ImportError:
        print("skipped: OpenCV for Python is not here (script/setup --tests)")
        return 77
    marey = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else made).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        two_clocks(marey, folder)
        camera_of_the_browser(marey, folder)
        trouble(marey, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())

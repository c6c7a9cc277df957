"""`marey evaluate` of SoccerNet's game states against sn-trackeval 0.4.0 on 20 made clips: every figure to 1e-9, alone and combined.

    game_state_test.py PROGRAM [SEED]

MAREY_SN_TRACKEVAL is a Python that has sn-trackeval (`pip install sn-trackeval==0.4.0`; its module has the name of trackeval's, so it
cannot stand beside that one). Without it the test exits 77 (skipped).
"""
import json
import os
import pathlib
import random
import subprocess
import sys
import tempfile
import time

PYTHON = os.environ.get("MAREY_SN_TRACKEVAL", "")
CLIPS, IMAGES, PEOPLE = 20, 60, 14
FIGURES = {"gs_hota": "HOTA", "deta": "DetA", "assa": "AssA", "detre": "DetRe", "detpr": "DetPr", "assre": "AssRe", "asspr": "AssPr",
           "loca": "LocA"}
# What the reference says of every clip and of all, by what must be equal; with the seconds that it took for GS-HOTA, and for all four.
REFERENCE = """
import contextlib, json, sys, time
import numpy as np
with contextlib.redirect_stdout(sys.stderr):
    import trackeval
    folder = sys.argv[1]
    results, took, took_all = {}, 0, 0
    for detail, used in (("numbers", (1, 1, 1)), ("teams", (1, 1, 0)), ("roles", (1, 0, 0)), ("places", (0, 0, 0))):
        start = time.perf_counter()
        data = trackeval.datasets.SoccerNetGS({"GT_FOLDER": folder + "/truth", "TRACKERS_FOLDER": folder + "/trackers", "SPLIT_TO_EVAL": "valid",
            "USE_ROLES": bool(used[0]), "USE_TEAMS": bool(used[1]), "USE_JERSEY_NUMBERS": bool(used[2]), "TRACKERS_TO_EVAL": ["made"], "PRINT_CONFIG": False})
        evaluator = trackeval.Evaluator({"USE_PARALLEL": False, "PRINT_RESULTS": False, "OUTPUT_SUMMARY": False, "OUTPUT_DETAILED": False, "PLOT_CURVES": False,
            "PRINT_CONFIG": False, "TIME_PROGRESS": False, "BREAK_ON_ERROR": True})
        found = evaluator.evaluate([data], [trackeval.metrics.HOTA()])[0]["SoccerNetGS"]["made"]
        results[detail] = {clip: {name: float(np.mean(value)) for name, value in result["person"]["HOTA"].items()}
                        for clip, result in found.items() if clip != "SUMMARIES"}
        took_all += time.perf_counter() - start
        if detail == "numbers":
            took = time.perf_counter() - start
print(json.dumps([results, took, took_all]))
"""


def annotation(number, image_id, track, place, role, team, jersey):
    x, y = place
    return {"id": str(number), "image_id": image_id, "track_id": track, "supercategory": "object", "category_id": 1,
            "attributes": {"role": role, "team": team, "jersey": jersey},
            "bbox_image": {"x": 1, "y": 2, "x_center": 3, "y_center": 4, "w": 5, "h": 6},
            "bbox_pitch": {"x_bottom_left": x - 0.3, "y_bottom_left": y, "x_bottom_right": x + 0.3, "y_bottom_right": y, "x_bottom_middle": x,
                           "y_bottom_middle": y}}


def made_person(rng, index):
    role = "player" if index < 9 else rng.choice(["player", "goalkeeper", "goalkeeper", "referee", "other", "ball"])
    team = rng.choice(["left", "right"]) if role in ("player", "goalkeeper") else None
    jersey = rng.choice([None, str(rng.randint(1, 5)), "07"]) if role in ("player", "goalkeeper") else None
    return {"role": role, "team": team, "jersey": jersey, "place": [rng.uniform(-30, 30), rng.uniform(-20, 20)],
            "speed": [rng.uniform(-0.3, 0.3), rng.uniform(-0.2, 0.2)]}


def made_clip(rng, prefix):
    """Truth and predictions of people who cross; places err, some by more than 5 m; roles, teams, numbers flicker; people are lost, invented,
    swapped. Images that are not labelled, of another clip, and short ids of the first release."""
    people = [made_person(rng, i) for i in range(PEOPLE)]
    names = list(range(1, PEOPLE + 1))
    images, truth, stated = [], [], []
    for frame in range(IMAGES):
        image_id = f"{prefix}{frame + 1:06d}"
        labelled = rng.random() > 0.05
        images.append({"is_labeled": True, "image_id": image_id, "file_name": f"{frame + 1:06d}.jpg", "has_labeled_person": labelled,
                       "has_labeled_pitch": True, "has_labeled_camera": True})
        truth.append({"id": "0", "image_id": image_id, "track_id": None, "supercategory": "pitch", "category_id": 5, "lines": {}})
        if rng.random() < 0.1:
            a, b = rng.sample(range(PEOPLE), 2)
            names[a], names[b] = names[b], names[a]
        blind = rng.random() < 0.05
        for index, person in enumerate(people):
            person["place"] = [a + b for a, b in zip(person["place"], person["speed"])]
            if rng.random() < 0.95:
                truth.append(annotation(len(truth), image_id, index + 1, person["place"], person["role"], person["team"], person["jersey"]))
            if blind or rng.random() < 0.1:
                continue
            place = [value + rng.gauss(0, rng.choice([0, 0.2, 1, 4])) for value in person["place"]]
            role, team, jersey = person["role"], person["team"], person["jersey"]
            if rng.random() < 0.1:
                role = rng.choice(["player", "goalkeeper", "referee", "other"])
            if rng.random() < 0.1:
                team = rng.choice(["left", "right", None])
            if rng.random() < 0.2:
                jersey = rng.choice([None, "1", "2", "7"])
            other = rng.random()
            shown = f"{frame:04d}" if other < 0.1 else f"3999{frame + 1:06d}" if other < 0.13 else image_id
            stated.append(annotation(len(stated), shown, names[index], place, role, team, jersey))
        if rng.random() < 0.3:
            stated.append(annotation(len(stated), image_id, 100 + frame % 3, [rng.uniform(-30, 30), 0], "player", "left", "9"))
    return {"info": {"version": "1.3", "name": "made", "im_dir": "img1", "frame_rate": 25, "seq_length": IMAGES, "im_ext": ".jpg"},
            "images": images, "annotations": truth, "categories": [{"id": 1, "name": "player"}]}, {"predictions": stated}


def make(folder, rng):
    (folder / "trackers/SoccerNetGS-valid/made/data").mkdir(parents=True)
    for number in range(CLIPS):
        clip = f"SNGS-{number + 21:03d}"
        truth, stated = made_clip(rng, f"2{number + 21:03d}")
        if number == 17:
            stated["predictions"] = []
        if number == 18:
            truth["annotations"] = truth["annotations"][:1]
        if number == 19:  # every identity is exchanged
            for one in stated["predictions"]:
                one["attributes"]["role"] = "other"
            for one in truth["annotations"][1:]:
                one.get("attributes", {})["role"] = "referee"
        (folder / "truth/valid" / clip).mkdir(parents=True)
        (folder / "truth/valid" / clip / "Labels-GameState.json").write_text(json.dumps(truth))
        (folder / "trackers/SoccerNetGS-valid/made/data" / f"{clip}.json").write_text(json.dumps(stated))


def differences(ours, reference):
    problems = []
    clips = {one["clip"]: one for one in ours["clips"]} | {"COMBINED_SEQ": ours}
    for clip, found in clips.items():
        theirs = reference["numbers"][clip]
        pairs = [(name, found[name], theirs[of]) for name, of in FIGURES.items()]
        pairs += [(f"hota_of {detail}", found["hota_of"][detail], reference[detail][clip]["HOTA"]) for detail in reference]
        problems += [f"{clip}: {name} is {a}, sn-trackeval says {b}" for name, a, b in pairs if not abs(a - b) <= 1e-9]
    return problems, len(clips)


def main(program, seed):
    if not PYTHON or subprocess.run([PYTHON, "-c", "import trackeval.datasets.soccernet_gs"], capture_output=True).returncode:
        print("skipped: MAREY_SN_TRACKEVAL is not a Python that has sn-trackeval 0.4.0")
        return 77
    print(f"seed {seed}")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        make(folder, random.Random(seed))
        done = subprocess.run([PYTHON, "-c", REFERENCE, folder], capture_output=True, text=True)
        assert done.returncode == 0, done.stderr[-3000:]
        reference, took, took_all = json.loads(done.stdout.splitlines()[-1])
        start = time.perf_counter()
        done = subprocess.run([program, "evaluate", "--truth", folder / "truth/valid", "--tracks", folder / "trackers/SoccerNetGS-valid/made", "--json"],
                              capture_output=True, text=True)
        ours_took = time.perf_counter() - start
        assert done.returncode == 0, done.stderr
        problems, compared = differences(json.loads(done.stdout), reference)
    print("\n".join(problems) or f"marey evaluate agrees with sn-trackeval on {compared - 1} clips and all together; GS-HOTA "
          f"{reference['numbers']['COMBINED_SEQ']['HOTA']:.4f}; {ours_took:.2f} s for four measures, sn-trackeval {took_all:.2f} s, {took:.2f} s for GS-HOTA alone")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else random.SystemRandom().randrange(2**32)))

"""Boxes of people before a static camera still, pans, zooms, rolls or shakes, with their truth: nothing is rendered.

A scene is people on a ground (metres, z up) before a pinhole camera whose pan, tilt, roll and focal length change with time.
Walkers stroll, stop and meet; athletes sprint, brake, turn, mark each other, crouch and jump, and the camera follows the play
as an operator does, late. A box is the projection of a person between sole and crown, as wide as the pose of the instant.
"""
import collections
import dataclasses
import math

import numpy as np

WIDTH, HEIGHT = 1280, 720


@dataclasses.dataclass(frozen=True)
class Scene:
    name: str
    seconds: float
    rate: float
    people: int
    sport: bool
    size: tuple           # of the ground that people move on, m
    camera: tuple         # where it stands, m
    aim: tuple            # what it shows at first, m
    focal: float          # px
    pan_fraction: float = 0     # share of the play's displacement that the operator pans after
    pan: float = 0        # degrees, amplitude of a slow pan to and fro
    period: float = 14    # s, of that pan and of the zoom
    zoom: float = 0       # amplitude of the logarithm of the focal length
    shake: float = 0      # px, standard deviation of a quick shaking
    roll: float = 0       # degrees, amplitude
    jumps: float = 0      # a second and person


def street(name, **more):
    return Scene(name, 20, 25, 14, False, (18, 14), (9, -8, 4.5), (9, 5, 0.6), 900, **more)


SCENES = [
    street("street, still"),
    street("street, slow pan", pan=7),
    street("street, zoom", zoom=0.2),
    street("street, shaken", shake=3, roll=0.5),
    Scene("basketball, panned", 20, 25, 10, True, (28, 15), (14, -13, 5), (14, 6, 0.8), 1150, pan_fraction=0.8),
    Scene("football, panned", 20, 25, 16, True, (60, 40), (30, -30, 12), (30, 18, 0.8), 2000, pan_fraction=0.9),
    Scene("football, panned and zoomed, 30 Hz", 20, 30, 16, True, (60, 40), (30, -30, 12), (30, 18, 0.8), 2000, pan_fraction=0.9,
          zoom=0.25, period=9),
    Scene("volleyball, jumps", 20, 25, 12, True, (18, 9), (-9, 4.5, 4), (9, 4.5, 1), 1100, pan_fraction=0.2, jumps=0.12),
    Scene("basketball, by hand", 20, 30, 10, True, (28, 15), (14, -13, 3), (14, 6, 0.8), 1150, pan_fraction=0.8, shake=2.5, roll=1.5),
]


class Noise:
    """An AR(1) process of unit variance."""

    def __init__(self, draw, shape, constant, dt):
        self.draw, self.keep = draw, math.exp(-dt / constant)
        self.value = draw.normal(size=shape)

    def step(self):
        self.value = self.keep * self.value + math.sqrt(1 - self.keep ** 2) * self.draw.normal(size=self.value.shape)
        return self.value


class Crowd:
    """Where every person is, and how they hold themselves."""

    def __init__(self, scene, draw, dt):
        self.scene, self.draw, self.dt = scene, draw, dt
        n = scene.people
        self.field = np.array(scene.size, dtype=float)
        self.place = draw.uniform(size=(n, 2)) * self.field
        self.velocity = np.zeros((n, 2))
        self.wanted = np.zeros((n, 2))
        self.play = self.field / 2
        self.play_velocity = np.zeros(2)
        self.tall = draw.normal(1.78, 0.08, n)
        self.phase = draw.uniform(0, 2 * math.pi, n)
        self.crouch = Noise(draw, n, 0.5, dt)
        self.arms = Noise(draw, n, 0.3, dt)
        self.drift = Noise(draw, 2, 3.0, dt)
        self.up = np.zeros(n)
        self.rise = np.zeros(n)
        for person in range(n):
            self.decide(person)

    def decide(self, person):
        draw, scene = self.draw, self.scene
        if scene.sport:
            speed = draw.choice([0.3, 2.2, 4.5, 7.0], p=[0.25, 0.35, 0.28, 0.12])
            towards = self.play + draw.normal(0, 0.22, 2) * self.field - self.place[person]
            angle = math.atan2(towards[1], towards[0]) + draw.normal(0, 0.7)
        else:
            speed = draw.choice([0.0, draw.normal(1.35, 0.25)], p=[0.15, 0.85])
            inside = (self.place[person] > 1).all() and (self.place[person] < self.field - 1).all()
            towards = self.field / 2 - self.place[person]
            angle = draw.uniform(0, 2 * math.pi) if inside else math.atan2(towards[1], towards[0]) + draw.normal(0, 0.4)
        self.wanted[person] = speed * np.array([math.cos(angle), math.sin(angle)])

    def step(self):
        scene, draw, dt = self.scene, self.draw, self.dt
        self.play_velocity += ((self.drift.step() * 5 * np.array([1, 0.5]) + 0.5 * (self.field / 2 - self.play))
                               - self.play_velocity) * dt
        self.play = np.clip(self.play + self.play_velocity * dt, 0.1 * self.field, 0.9 * self.field)
        often = 0.9 if scene.sport else 0.15
        for person in np.flatnonzero(draw.uniform(size=len(self.place)) < often * dt):
            self.decide(person)
        wanted = self.wanted.copy()
        if scene.sport:  # every other person marks the one before
            to_man = self.place[0::2][:len(self.place[1::2])] - self.place[1::2]
            wanted[1::2] = 0.45 * wanted[1::2] + 0.55 * (self.velocity[0::2][:len(to_man)] + 1.2 * to_man)
        change = wanted - self.velocity
        most = (5.0 if scene.sport else 1.2) * dt
        size = np.linalg.norm(change, axis=1, keepdims=True)
        self.velocity += change * np.minimum(1, most / np.maximum(size, 1e-9))
        apart = self.place[:, None] - self.place[None]
        distance = np.linalg.norm(apart, axis=2) + 10 * np.eye(len(self.place))
        push = np.where((distance < 0.55)[..., None], apart / distance[..., None] * (0.55 - distance)[..., None], 0).sum(1)
        self.place = self.place + self.velocity * dt + 0.5 * push
        low, high = (0 * self.field, self.field) if scene.sport else (-2.0 + 0 * self.field, self.field + 2.0)
        out = (self.place < low) | (self.place > high)
        self.wanted = np.where(out, -np.sign(self.place - self.field / 2) * np.abs(self.wanted), self.wanted)
        self.place = np.clip(self.place, low - 0.5, high + 0.5)
        begun = (self.up <= 0) & (draw.uniform(size=len(self.up)) < scene.jumps * dt)
        self.rise = np.where(begun, draw.uniform(2.2, 3.6, len(self.up)), self.rise - 9.81 * dt * (self.up > 0))
        self.up = np.maximum(0, self.up + self.rise * dt * (begun | (self.up > 0)))

    def poses(self):
        """(height above the sole, width), m"""
        speed = np.linalg.norm(self.velocity, axis=1)
        self.phase += 2 * math.pi * (0.9 + 0.25 * np.minimum(speed, 5)) * self.dt
        crouch, arms = self.crouch.step(), self.arms.step()
        share = (0.05 if self.scene.sport else 0.01)
        tall = self.tall * (0.97 - share * np.abs(crouch) - 0.01 * np.abs(np.sin(self.phase)))
        stride = np.minimum(speed / (5 if self.scene.sport else 3), 1) * np.abs(np.sin(self.phase))
        wide = self.tall * (0.27 + 0.22 * stride + (0.09 if self.scene.sport else 0.015) * np.abs(arms))
        return tall, wide


class Operator:
    """The camera over time: rotation and focal length."""

    def __init__(self, scene, draw, dt):
        self.scene, self.dt, self.draw = scene, dt, draw
        self.aim = np.array(scene.aim, dtype=float)
        self.first = self.aim.copy()
        self.speed = np.zeros(3)
        self.shake = [Noise(draw, 2, 0.08, dt), Noise(draw, 2, 0.5, dt), Noise(draw, 1, 0.8, dt)]
        self.phase = draw.uniform(0, 2 * math.pi, 3)

    def step(self, time, play):
        scene = self.scene
        goal = self.first + scene.pan_fraction * np.append(play - np.array(scene.size) / 2, 0)
        goal[1] = self.first[1] + 0.5 * (goal[1] - self.first[1])
        self.speed += (4 * (goal - self.aim) - 3.2 * self.speed) * self.dt   # late, and a little over the mark
        self.aim = self.aim + self.speed * self.dt
        turn = 2 * math.pi * time / scene.period
        look = self.aim - np.array(scene.camera)
        pan = math.atan2(look[0], look[1]) + math.radians(scene.pan) * math.sin(turn + self.phase[0])
        tilt = math.atan2(look[2], math.hypot(look[0], look[1]))
        roll = math.radians(scene.roll) * float(self.shake[2].step()[0])
        focal = scene.focal * math.exp(scene.zoom * math.sin(turn + self.phase[1]))
        shift = scene.shake * (0.8 * self.shake[0].step() + 0.6 * self.shake[1].step())
        return pan, tilt, roll, focal, shift

    def project(self, points, state):
        pan, tilt, roll, focal, shift = state
        forward = np.array([math.sin(pan) * math.cos(tilt), math.cos(pan) * math.cos(tilt), math.sin(tilt)])
        right = np.array([math.cos(pan), -math.sin(pan), 0])
        down = -np.cross(right, forward)
        away = points - np.array(self.scene.camera)
        depth = away @ forward
        x, y = focal * (away @ right) / depth, focal * (away @ down) / depth
        turned = np.stack([math.cos(roll) * x - math.sin(roll) * y, math.sin(roll) * x + math.cos(roll) * y], axis=1)
        return turned + shift + np.array([WIDTH, HEIGHT]) / 2, depth


def truth(scene, seed, box_draw=None):
    """{frame: {person: (left, top, width, height)}}, frames from 1; what is mostly outside the image is omitted.

    With a generator of its own for the boxes' noise, `box_draw`, what people do does not depend on who is in the image.
    """
    dt = 1 / scene.rate
    draw = np.random.default_rng([seed, sum(map(ord, scene.name))])
    crowd, camera = Crowd(scene, draw, dt), Operator(scene, draw, dt)
    for _ in range(int(3 * scene.rate)):  # until every person has spread
        crowd.step()
        camera.step(0, crowd.play)
    boxes = collections.defaultdict(dict)
    for frame in range(1, int(scene.seconds * scene.rate) + 1):
        crowd.step()
        state = camera.step(frame * dt, crowd.play)
        tall, wide = crowd.poses()
        sole = np.column_stack([crowd.place, crowd.up])
        crown = np.column_stack([crowd.place, crowd.up + tall])
        low, depth = camera.project(sole, state)
        high, _ = camera.project(crown, state)
        for person in range(len(tall)):
            if depth[person] < 1:
                continue
            height = low[person, 1] - high[person, 1]
            width = wide[person] * height / tall[person] + abs(low[person, 0] - high[person, 0]) * 0.5
            left, top = (low[person, 0] + high[person, 0] - width) / 2, high[person, 1]
            l, t = max(left, 0), max(top, 0)
            w, h = min(left + width, WIDTH) - l, min(top + height, HEIGHT) - t
            if w > 0 and h > 0 and w * h > 0.35 * width * height and height > 12:
                noise = (box_draw or draw).normal(0, 0.3, 4)
                boxes[frame][person + 1] = (l + noise[0], t + noise[1], w + noise[2], h + noise[3])
    return boxes


def with_sure_scores(boxes):
    return {frame: [(*box, 1.0) for box in people.values()] for frame, people in boxes.items()}


def write_truth(path, boxes):
    with open(path, "w") as file:
        for frame in sorted(boxes):
            for person, (left, top, width, height) in sorted(boxes[frame].items()):
                file.write(f"{frame},{person},{left:.2f},{top:.2f},{width:.2f},{height:.2f},1,-1,-1,-1\n")

"""Keyword arguments of the jobs; written by script/job-options from src/marey/pipeline/jobs, not by hand."""

from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Literal, TypedDict

Path = str | os.PathLike[str]


class TrackOptions(TypedDict, total=False):
    detections: Path | None
    r"""in place of INPUT, detections: MOT text, frame,-1,left,top,width,height,score; of markers the output of marey detect"""
    rate: float | None
    r"""Hz in [0.001, 1e6]: frame rate, if the file does not specify it or is wrong"""
    overlay: Path | None
    r"""a video with boxes, IDs and trails drawn into the images: FILE.mp4"""
    plot: Path | None
    r"""the trajectories as one image, in its coordinates: FILE.svg"""
    blur: Literal["faces"] | None
    r"""make heads unrecognisable in --overlay and --copy: those of the people who are tracked: faces"""
    copy: Path | None
    r"""the video again with nothing drawn and faces blurred: FILE.mp4"""
    foreground_masks: Path | None
    r"""a new folder for the output of the background model: bin000001.png of the first frame, white on black"""
    live: bool | None
    r"""write each frame's tracks at once; nothing is corrected by later frames"""
    lag: float | None
    r"""s in [0, 60]: with --live: use the frames of this duration before each frame's tracks are written (default: 0)"""
    stabilise: bool | None
    r"""the camera shakes (wind, steps): stabilise its images first; results are in the pixels of its rest"""
    measured_only: bool | None
    r"""omit the rows of people who were not detected in that frame"""
    background: Literal["marey", "mog2", "knn"] | None
    r"""model of the static background: marey, mog2, knn (default: marey)"""
    detector_interval: int | None
    r"""N in [1, 1000]: run the network on every N-th frame (default: 1)"""
    no_background: bool | None
    r"""the network alone"""
    numbers: Path | None
    r"""each person's shirt number, read in the images, with its probability: FILE.csv; from when it is known it is in overlays too (network: script/model --numbers)"""
    contour: bool | None
    r"""track each person's outline too: a closed spline"""
    control_points: int | None
    r"""N in [3, 64]: of each outline (default: as many as its silhouette needs, at most 40)"""
    spline_order: int | None
    r"""N in [2, 8]: of the spline, degree + 1 (default: 4, cubic)"""
    measurement_lines: int | None
    r"""N in [1, 512]: measurement lines across each outline, along which it is searched (default: 24)"""
    target_masks: Path | None
    r"""a new folder for the pixels of each person's contour: target000001.png of the first frame, 16 bits, a pixel's value is the number of the person that it shows"""
    contour_model: str | None
    r"""a network whose masks of people count as evidence beside colours: lite, full or heavy (script/model), or a FILE.onnx (default: none)"""
    model: str | None
    r"""the network that finds the points: lite, full or heavy, each slower and more accurate than the one before (script/model), or a FILE.onnx (default: full)"""
    threshold: float | None
    r"""grey level in [0, 65535]: that the pixels of a marker exceed, 0 to 255 or 65535 (default: from the image noise)"""
    dark: bool | None
    r"""markers are darker than their surroundings"""
    max_width: float | None
    r"""px in [2, 200]: largest width of a marker; wider regions are removed from the image (default: only where they disturb)"""
    max_markers: int | None
    r"""N in [1, 1000000]: per frame; beyond, those at predicted positions are kept, then the largest (default: 5000)"""
    min_area: float | None
    r"""px^2 in [0, 1e8]: smallest marker, pixels that exceed the threshold (default: 2)"""
    max_area: float | None
    r"""px^2 in [0, 1e8]: largest marker, likewise (default: 10000)"""
    min_roundness: float | None
    r"""fraction in [0, 1]: area over that of the circle as long as the blob: 1 is a disc, an ellipse has the ratio of its axes (default: 0.25)"""
    colour: str | None
    r"""markers of this hue, in degrees: 0 red, 60 yellow, 120 green, 180 cyan, 240 blue, 300 magenta; 120+-15 sets the tolerance"""
    saturation: float | None
    r"""fraction in [0.001, 0.999]: with --colour: minimum of (largest - smallest of red, green, blue), as a fraction of white (default: 0.2)"""
    mask: Path | None
    r"""an image of the video's size; what is not black in it is omitted"""
    auto_mask: float | None
    r"""s in [0, 3600]: omit what is bright and static in the first N seconds (lamps, reflections, and markers that do not move); 0: off (default: 0)"""
    estimate_noise: bool | None
    r"""estimate process and measurement noise from the recording"""


class GroundOptions(TypedDict, total=False):
    rate: float | None
    r"""Hz in [0.001, 1e6]: frame rate, if the file does not specify it or is wrong"""
    overlay: Path | None
    r"""a folder for such a video of each camera, CAMERA.mp4"""
    blur: Literal["faces"] | None
    r"""make heads unrecognisable in --overlay and --copy: those of the people who are tracked: faces"""
    copy: Path | None
    r"""a folder for the videos with nothing drawn and faces blurred, CAMERA.mp4"""
    live: bool | None
    r"""write each frame's tracks at once; nothing is corrected by later frames"""
    stabilise: bool | None
    r"""the camera shakes (wind, steps): stabilise its images first; results are in the pixels of its rest"""
    background: Literal["marey", "mog2", "knn"] | None
    r"""model of the static background: marey, mog2, knn (default: marey)"""
    detector: Path | None
    r"""a detection network in addition to the background model: the file that describes it (docs/network.md)"""
    detector_interval: int | None
    r"""N in [1, 1000]: run the network on every N-th frame (default: 1)"""
    no_background: bool | None
    r"""the network alone"""
    numbers: Path | None
    r"""each person's shirt number, read in the images, with its probability: FILE.csv; from when it is known it is in overlays too (network: script/model --numbers)"""
    size: str | tuple[float, float] | None
    r"""m, of the pitch, or of any other rectangle from the origin on (default: 105x68 if the rig was calibrated on a pitch, else people count everywhere)"""
    area: str | Sequence[tuple[float, float]] | None
    r"""where people count, in place of a pitch: its corners in order, "x,y x,y x,y" in m, or LENGTHxWIDTH"""
    margin: float | None
    r"""m in [0, 1000]: around the pitch or the area in which people still count (default: 2)"""
    teams: str | None
    r'''the teams' colours, "white,blue", or their names too, "City=white,United=blue"'''
    association: Literal["gnn", "jpda", "mht", "bramble"] | None
    r"""data association (default: mht; gnn with live cameras or --live, and for boxes whose cameras agree); bramble tracks by particles in the images, without detections: gnn, jpda, mht, bramble"""
    ball: bool | None
    r"""track the ball too: a track named "ball", with its height"""
    pitch_view: Path | None
    r"""a video of the ground from above, with the trail of each person: FILE.mp4"""


class ReconstructOptions(TypedDict, total=False):
    labels: Path | None
    r"""the markers' labels: CSV label,x,y,z of their positions at the beginning (m), or one label per line, by increasing x"""
    marker_set: Path | None
    r"""label the markers, frame by frame, by a set that "marey label learn" made: set.toml"""
    skeleton: Path | None
    r"""solve the pose of this skeleton from the labelled markers in each frame: skeleton.toml or .osim, fitted to the person (marey solve --write-skeleton)"""
    rate: float | None
    r"""Hz in [0.001, 1e6]: frame rate, if neither the sources nor the rig specify it"""
    noise: float | None
    r"""px in [0.001, 100]: standard deviation of a blob's position and of the calibration (default: learned)"""
    max_gap: float | None
    r"""s in [0, 10]: the longest gap that is filled (default: 0.5)"""
    max_prediction: float | None
    r"""s in [0, 10]: write predictions for this duration of a longer gap; at most --max-gap (default: 0)"""
    live: bool | None
    r"""write every instant at once, as marey live does: no gap is filled"""
    marker_diameter: float | None
    r"""m in [0.0001, 1]: markers closer than this disturb each other (default: 0.02)"""
    max_speed: float | None
    r"""m/s in [0.001, 10000]: the largest speed of a marker (default: 15)"""
    threshold: float | None
    r"""grey level in [0, 65535]: that the pixels of a marker exceed, 0 to 255 or 65535 (default: from the image noise)"""
    dark: bool | None
    r"""markers are darker than their surroundings"""
    max_width: float | None
    r"""px in [2, 200]: largest width of a marker; wider regions are removed from the image (default: only where they disturb)"""
    max_markers: int | None
    r"""N in [1, 1000000]: per frame; beyond, those at predicted positions are kept, then the largest (default: 5000)"""
    min_area: float | None
    r"""px^2 in [0, 1e8]: smallest marker, pixels that exceed the threshold (default: 2)"""
    max_area: float | None
    r"""px^2 in [0, 1e8]: largest marker, likewise (default: 10000)"""
    min_roundness: float | None
    r"""fraction in [0, 1]: area over that of the circle as long as the blob: 1 is a disc, an ellipse has the ratio of its axes (default: 0.25)"""
    keypoint_set: str | None
    r"""the keypoint set of files that do not name their points: body_25, body_25b, coco_18, coco, halpe_26, blazepose (default: by the points)"""
    people: int | None
    r"""N in [0, 1000]: keep the N people in the most images; 0: all (default: 0)"""
    no_smooth: bool | None
    r"""each instant by itself: no trajectories over all instants, no gap filled"""
    no_offsets: bool | None
    r"""cameras without an offset in the rig are taken as synchronous; default: offsets are found by the motion of people"""
    max_offset: float | None
    r"""s in [0.01, 10]: the largest offset that is searched (default: 0.5)"""
    model: str | None
    r"""the network that finds the points: lite, full or heavy, each slower and more accurate than the one before (script/model), or a FILE.onnx (default: full)"""
    detector: Path | None
    r"""a detection network in place of the one for people: the file that describes it (docs/network.md)"""
    with_background: bool | None
    r"""people are detected by what changes too, which is faster; default: by the network alone"""
    detector_interval: int | None
    r"""N in [1, 1000]: run the networks on every N-th frame (default: 1)"""


class SolveOptions(TypedDict, total=False):
    skeleton: Path | None
    r"""OpenSim's .osim, Vicon's .vsk, .bvh, .asf, or a skeleton.toml (docs/skeleton.md); omitted: the human skeleton"""
    static_trial: Path | None
    r"""the person standing still. With a marker set of the field it makes the human skeleton, where no --skeleton is given; beside --skeleton and --calibrate it says where joints are straight; without either it is made from RECORDING alone: from its body keypoints, or, less surely, from its markers"""
    marker_set: str | None
    r"""whose labels --static-trial, or RECORDING without one, has: plug-in-gait, cmu-41, helen-hayes or cleveland-clinic; omitted: found by the labels"""
    rom_trial: Path | None
    r"""beside --static-trial: the same person moving hips, knees and elbows through their range; states where the joints are"""
    person: str | None
    r"""of several people whose body keypoints RECORDING has the one to solve: P2; omitted: the first"""
    calibrate: bool | None
    r"""first fit the skeleton's sizes and its markers' places to the person, from RECORDING itself"""
    smooth: bool | None
    r"""a second pass over the whole motion: what was hidden is bent to both ends"""
    calibration_take: Sequence[str] | None
    r"""another recording of the same person with the same markers, for --calibrate; may be given often"""
    mass: float | None
    r"""kg in [1, 500]: the person's mass, for the masses of --write-skeleton's .osim"""
    write_skeleton: Path | None
    r"""the skeleton that was used: skeleton.toml, or, of an OpenSim model, .osim with its bodies scaled and markers moved"""
    exclude: Sequence[str] | None
    r"""a marker that is not used, by its label; may be given often"""
    up: Literal["y", "z"] | None
    r"""the axis that is up in RECORDING; omitted: y for a TRC file beside an OpenSim model, else as it states, else z: y, z"""
    unit: float | None
    r"""m in (0, 1000]: one unit of a BVH skeleton that is read, in metres: 0.01 is cm, 0.0254 inches (default: 0.01)"""
    skeleton_up: Literal["y", "z"] | None
    r"""the axis that is up in a BVH, ASF or VSK skeleton: y, z (default: y)"""
    bvh_unit: float | None
    r"""m in (0, 1000]: one unit of a BVH file that is written; omitted: 0.01, or as --rig-names has it"""
    bvh_up: Literal["y", "z"] | None
    r"""the axis that is up in a BVH file that is written; omitted: y, or as --rig-names has it: y, z"""
    bvh_order: Literal["ZXY", "ZYX", "XYZ", "XZY", "YXZ", "YZX"] | None
    r"""the order of its rotations; omitted: ZXY, or as --rig-names has it: ZXY, ZYX, XYZ, XZY, YXZ, YZX"""
    rig_names: str | None
    r"""whose bones .bvh and .glb have (names, rest pose, BVH's unit, axis and rotation order): mixamo, unreal, vrm, rokoko, rigify, motionbuilder; omitted: the skeleton's own"""


class AugmentOptions(TypedDict, total=False):
    height: float | None
    r"""m in [0.5, 2.6]: the person's height; always wanted"""
    mass: float | None
    r"""kg in [2, 500]: the person's mass; always wanted"""
    angles: Path | None
    r"""angles of hips, knees, ankles, ... at every instant with one standard deviation, degrees: .csv"""
    person: str | None
    r"""of several people whose body keypoints RECORDING has the one: P2; omitted: the first"""
    hips: Literal["keypoints", "joints"] | None
    r"""what RECORDING's hips are: as networks for keypoints have them, or the joints' centres, as a simulation or a marker-based model has them: keypoints, joints (default: keypoints)"""
    up: Literal["y", "z"] | None
    r"""the axis that is up in RECORDING; omitted: as it states, else z: y, z"""


class LiveOptions(TypedDict, total=False):
    ground: bool | None
    r"""people on the ground that the rig's cameras face"""
    size: str | tuple[float, float] | None
    r"""m, of the pitch, or of any other rectangle from the origin on (default: 105x68 if the rig was calibrated on a pitch, else people count everywhere)"""
    area: str | Sequence[tuple[float, float]] | None
    r"""where people count, in place of a pitch: its corners in order, "x,y x,y x,y" in m, or LENGTHxWIDTH"""
    margin: float | None
    r"""m in [0, 1000]: around the pitch or the area in which people still count (default: 2)"""
    teams: str | None
    r'''the teams' colours, "white,blue", or their names too, "City=white,United=blue"'''
    association: Literal["gnn", "jpda", "mht", "bramble"] | None
    r"""data association (default: mht; gnn with live cameras or --live, and for boxes whose cameras agree); bramble tracks by particles in the images, without detections: gnn, jpda, mht, bramble"""
    preroll: float | None
    r"""s in [0, 60]: kept from before a recording is switched on (default: 5)"""
    frame_timeout: float | None
    r"""s in [0.001, 1]: longest wait for a late frame of an instant (default: 0.05)"""
    connect_timeout: float | None
    r"""s in [0, 60]: longest wait for cameras at the beginning (default: 3)"""
    labels: Path | None
    r"""the markers' labels: CSV label,x,y,z of their positions at the beginning (m), or one label per line, by increasing x"""
    marker_set: Path | None
    r"""label the markers, frame by frame, by a set that "marey label learn" made: set.toml"""
    skeleton: Path | None
    r"""solve the pose of this skeleton from the labelled markers in each frame: skeleton.toml or .osim, fitted to the person (marey solve --write-skeleton)"""
    threshold: float | None
    r"""grey level in [0, 65535]: that the pixels of a marker exceed, 0 to 255 or 65535 (default: from the image noise)"""
    dark: bool | None
    r"""markers are darker than their surroundings"""
    max_width: float | None
    r"""px in [2, 200]: largest width of a marker; wider regions are removed from the image (default: only where they disturb)"""
    max_markers: int | None
    r"""N in [1, 1000000]: per frame; beyond, those at predicted positions are kept, then the largest (default: 5000)"""
    min_area: float | None
    r"""px^2 in [0, 1e8]: smallest marker, pixels that exceed the threshold (default: 2)"""
    max_area: float | None
    r"""px^2 in [0, 1e8]: largest marker, likewise (default: 10000)"""
    min_roundness: float | None
    r"""fraction in [0, 1]: area over that of the circle as long as the blob: 1 is a disc, an ellipse has the ratio of its axes (default: 0.25)"""
    background: Literal["marey", "mog2", "knn"] | None
    r"""model of the static background: marey, mog2, knn (default: marey)"""
    detector: Path | None
    r"""a detection network in addition to the background model: the file that describes it (docs/network.md)"""
    detector_interval: int | None
    r"""N in [1, 1000]: run the network on every N-th frame (default: 1)"""
    no_background: bool | None
    r"""the network alone"""
    numbers: Path | None
    r"""each person's shirt number, read in the images, with its probability: FILE.csv; from when it is known it is in overlays too (network: script/model --numbers)"""
    model: str | None
    r"""the network that finds the points: lite, full or heavy, each slower and more accurate than the one before (script/model), or a FILE.onnx (default: lite)"""
    people: int | None
    r"""N in [0, 1000]: of several cameras: track at most N people; 0: all (default: 0)"""

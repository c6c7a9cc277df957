// A recording of markers and a skeleton into the skeleton's motion: read, each marker found by its label, solved frame by frame,
// written as angles (.mot, .sto), as bones (.bvh, .glb), or as a recording with bodies.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/core/skeleton.h"
#include "marey/format/format.h"
#include "marey/format/skeleton/rig_names.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/pipeline/bodies/human_skeleton.h"
#include "marey/solve/skeleton/pose_solver.h"

namespace marey::pipeline::bodies {

struct SolveOptions {
  format::skeleton::SkeletonOptions read_skeleton;
  std::optional<format::UpAxis>
      up;  ///< of the recording; nothing: y where a TRC file meets an OpenSim model, else as it says, else z
  std::vector<std::string> exclude;    ///< labels of markers that are not used
  format::skeleton::BoneOutput bones;  ///< of .bvh and .glb
  solve::skeleton::PoseOptions pose;
  bool smooth = false;       ///< a second pass over the whole motion
  std::string static_trial;  ///< of the same person standing: makes the human skeleton, or shows a given one's calibration where
                             ///< joints are straight; empty: from the motion alone
  std::string marker_set;    ///< its name; empty: known by the labels
  std::string motion;        ///< and of its range of motion: where its joints are; empty: none
  std::string person;        ///< of several whose keypoints are recorded ("P2"), where neither is given; empty: the first
  bool calibrate = false;    ///< first fits the skeleton to the person, from the recording itself
  std::vector<std::string> calibration_takes = {};  ///< and from these of the same person with the same markers
  std::optional<double> mass_kg = {};               ///< of the person, for an .osim
  std::string write_skeleton;                       ///< skeleton.toml of what was solved with, or a calibrated .osim; empty: none
};

/// The result.
struct SolveSummary {
  struct Marker {
    std::string label;
    std::int64_t detected = 0;  ///< instants
    double rms_m = 0, worst_m = 0;
  };
  struct Coordinate {
    std::string name;
    bool is_rotation = true;
    double lowest = 0, highest = 0;  ///< rad or m
    double deviation = 0;            ///< median over the instants in which a marker was seen
    double observed = 0;             ///< share of those instants
  };

  std::string skeleton;
  std::int64_t frames = 0, empty = 0;  ///< instants; those without any of the skeleton's markers
  int skeleton_markers = 0;            ///< that the skeleton has
  double markers_a_frame = 0;          ///< seen on the mean, of instants with any
  double rate_hz = 0, seconds = 0;
  double rms_m = 0, worst_m = 0;          ///< of all markers, all instants
  std::int64_t starts = 0;                ///< poses found without the one before
  std::vector<Marker> markers;            ///< those used, by the skeleton's order
  std::vector<Coordinate> coordinates;    ///< that move by themselves
  std::vector<std::string> not_recorded;  ///< the skeleton's markers that the recording has not
  std::vector<std::string> not_known;     ///< the recording's labels that the skeleton has not
  std::string unused = {};                ///< what a model has that moves nothing here: muscles, wrapping surfaces
  std::vector<std::string> warnings;
  std::optional<double> overall_scale;  ///< of a calibration; with what it found:
  double rms_before_m = 0;
  std::string marker_set;                         ///< whose human skeleton it is; empty if it is another one
  std::vector<FoundJoint> joints;                 ///< of the human skeleton that the range of motion was asked for
  std::vector<std::string> undetermined;          ///< segments whose size the recording does not determine
  std::vector<std::string> undetermined_markers;  ///< markers whose place on their segments it does not determine
  bool stopped = false;
};

/// A whole recording solved: what the skeleton did, and what is to be said of it.
struct SolvedRecording {
  Skeleton skeleton;
  SkeletonMotion motion;                    ///< one row an instant
  std::vector<std::vector<bool>> observed;  ///< one row an instant, of each coordinate
  std::vector<double> residual_m;           ///< mean of each instant's markers; 0 where none was seen
  std::vector<Vector<3>> scales;            ///< of a calibration, by segment; empty without one
  SolveSummary summary;
};

/// Throws Error if none of the skeleton's markers is in the recording.
SolvedRecording solve_recording(const std::string& recording, const format::skeleton::SkeletonFile& skeleton,
                                const SolveOptions& options, const Hooks& hooks = {});

/// With a skeleton from a file, or where `skeleton` is empty the human one of the static trial, or else of the recording's own body
/// keypoints, or of its markers; calibrated where the options say so, and of markers alone always.
SolvedRecording solve_with_skeleton(const std::string& recording, const std::string& skeleton, const SolveOptions& options,
                                    const Hooks& hooks = {});

/// The same, and writes `outputs`, each in the format of its ending. `skeleton` is a file, or empty for the human one.
/// Throws WrongFormat, before anything is read, for an ending that holds no skeleton.
SolveSummary solve_skeleton(const std::string& recording, const std::string& skeleton, const std::vector<std::string>& outputs,
                            const SolveOptions& options, const Hooks& hooks = {});

/// For a command line: throws WrongFormat where nothing with a skeleton is written under that name.
void check_skeleton_output(const std::string& path);

}  // namespace marey::pipeline::bodies

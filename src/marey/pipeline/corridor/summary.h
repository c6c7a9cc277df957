// What a run found, and what it lost and why.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "marey/core/camera_health.h"
#include "marey/pipeline/corridor/clock.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::pipeline::corridor {

/// Of people in an image or on the ground: seen, and in no result.
struct Dropped {
  std::optional<std::int64_t> noise;                ///< regions too small to be a part of a person
  std::optional<std::int64_t> unexplained_regions;  ///< that no body explains
  std::optional<std::int64_t> too_short;            ///< tracks that were never confirmed
  std::optional<std::int64_t> no_person;            ///< boxes in which the keypoint network sees no person
  std::optional<std::int64_t> off_pitch;            ///< people who were never on the pitch
};

/// The noise that was estimated from markers in an image.
struct NoiseFigures {
  double measurement_px = 0;      ///< standard deviation along an axis
  double acceleration_px_s2 = 0;  ///< standard deviation of the motion's
};

struct SpacePointFigures {
  double noise_px = 0;                             ///< standard deviation of a blob's position
  std::optional<double> residual_px;               ///< root mean square of the reprojections; nothing without a point
  std::int64_t observations = 0, unexplained = 0;  ///< blobs; those that belong to no marker
  std::int64_t two_ray_points = 0;                 ///< not taken: two rays alone meet by chance
  std::map<reconstruct::NoPoint, std::int64_t> not_located;
};

struct MarkerSetFigures {
  std::int64_t points = 0, named = 0;  ///< since the set was found
  double searched_s = 0;
  std::optional<double> found_at_s;
};

struct SkeletonFigures {
  std::optional<double> rms_mm;  ///< of the markers about where the skeleton has them
  std::int64_t initialisations = 0;
};

struct GroundFigures {
  double linking_s = 0;  ///< wall time of the second pass
  std::int64_t links = 0, uncertain_links = 0;
  std::optional<std::int64_t> ball_samples;  ///< where a ball was asked for
};

struct KeypointFigures {
  std::int64_t people = 0;                 ///< distinct ones
  std::int64_t person_searches = 0;        ///< runs of the person detector
  std::int64_t regions = 0;                ///< runs of the landmark network
  std::int64_t people_in_images = 0;       ///< of all views
  std::int64_t people_located = 0;         ///< of these, used for a person in space
  std::optional<double> residual_px = {};  ///< root mean square of the reprojections, of videos
  double noise = 0;                        ///< residuals, in units of what the network states
};

/// What results from a run: the content of its results, the losses and their causes.
struct Summary {
  /// Its frames are those that were searched, its detections those that the tracker was given.
  struct Camera : CameraHealth {
    std::int64_t outside = 0;  ///< detections where nothing counts: beyond the area, above the horizon
    std::int64_t noise = 0;    ///< regions too small to be a part of a person
    std::int64_t misfits = 0;  ///< regions that no body explains
  };
  /// How long one step took, s.
  struct StepTime {
    std::string name;
    std::int64_t count = 0;
    double median = 0, p99 = 0;
  };

  std::int64_t frames = 0;                                           ///< instants
  double seconds = 0;                                                ///< from the first moment to the last
  double rate_hz = 0;                                                ///< of the instants
  double first_pass_s = 0;                                           ///< wall time until the cameras had ended
  std::int64_t tracks = 0;                                           ///< distinct ones in the results
  std::int64_t labelled = 0;                                         ///< of these, with a label
  std::int64_t samples = 0;                                          ///< tracks times the instants they are in
  std::int64_t measured = 0, filled = 0, predicted = 0, solved = 0;  ///< of these
  std::int64_t outlines = 0, held_outlines = 0;  ///< samples with an outline; those of which too little was seen
  std::int64_t keypoints = 0;                    ///< samples with body points
  std::int64_t detections = 0;                   ///< handed to the tracker
  Dropped dropped;
  std::optional<LiveDrops> live;  ///< instants and frames that a live run lost
  std::optional<NoiseFigures> noise;
  std::optional<SpacePointFigures> points;
  std::optional<MarkerSetFigures> marker_set;
  std::optional<SkeletonFigures> skeleton;
  std::optional<GroundFigures> ground;
  std::optional<KeypointFigures> body_points;
  std::vector<Camera> cameras;
  std::vector<StepTime> steps;
  std::vector<std::string> notes;     ///< additional findings, one sentence each
  std::vector<std::string> warnings;  ///< what went wrong without stopping the run, one sentence each
  bool stopped = false;               ///< before the end, because a hook said so
  bool sink_failed = false;           ///< of a live run: a warning names it
};

/// One cause of losses: `key` for programs, `description` for a line of text.
struct Exclusion {
  std::string_view key;
  std::string_view description;
  std::int64_t count = 0;
};

/// All that this run counted, also those of which there were none.
std::vector<Exclusion> exclusions(const Summary& summary);
/// All figures of the parts that ran, by the names of their members.
std::vector<std::pair<std::string_view, double>> figures(const Summary& summary);

}  // namespace marey::pipeline::corridor

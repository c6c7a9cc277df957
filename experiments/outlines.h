#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/simulate/people/people_video.h"
#include "marey/track/contour/contour_tracker.h"

#include "experiments/published_outline.h"

namespace marey::experiments {

/// What one outline tracker made of one case. A person counts while at least half of them is visible, from the frame in
/// which the method first has an outline on him; an outline that is missing then overlaps nothing.
struct OutlineScore {
  int people = 0;
  int lost = 0;                        ///< whose name was lost: see evaluate_labels; or never given
  std::int64_t frames = 0;             ///< people times the frames that count
  double tracked = 0;                  ///< share of these with an outline of the right name on the person
  double iou = 0;                      ///< mean, with the true silhouette, hidden parts included, within the image
  std::optional<double> centre_error;  ///< px, mean distance to the true silhouette's centre, where the outline is on the person
  std::optional<double> jitter;        ///< px, RMS of the second difference of the centre from frame to frame
  /// Mean IoU of what is visible: of people alone; of the nearer and the farther of two who overlap by 20 to 70 %.
  std::optional<double> alone, front, behind;
  std::int64_t curves = 0, wild = 0;  ///< followed outlines; those that cross themselves or are beyond their target's size
  std::optional<double> target_us;    ///< µs a person and frame, of the following alone
};

/// Clips of one kind.
struct OutlineCase {
  std::string name;
  simulate::people::PeopleSituation situation{};
  double height_px = 60;
  bool recorded = false;     ///< as a camera with sharpening and a codec gives it
  bool same_shirts = false;  ///
  simulate::people::LightChange light = simulate::people::LightChange::constant;
  int videos = 1;
  int people = 0;
  std::optional<double> true_jitter = {};  ///< px, as in OutlineScore, of the true silhouettes' centres
};

struct OutlineExperiment {
  struct Row {
    std::string method;
    std::vector<OutlineScore> scores;  ///< one a case
  };
  std::uint64_t seed = 0;
  std::vector<OutlineCase> cases;
  std::vector<Row> rows;
};

struct OutlineExperimentOptions {
  int videos = 50;  ///< of two people who cross or are hidden; of the other cases, with six people each, a tenth
  std::uint64_t seed = 1;
  std::string only;  ///< names of cases that hold this text; empty for all
  track::contour::OutlineOptions outlines;
  PublishedOptions published;
};

/// The same videos, seen once by Marey's detector, tracked by four methods with settings that are the same for all cases:
///   silhouettes  the detector's own outlines under the tracker's names: what there is without any outline filter
///   boxes        the box filter of Xu et al., fed with the nearest detection
///   published    the coupled filters of Arnaut & Costa, after De Bem
///   Marey        the tracker with ContourTracker
/// Boxes and published filters have no birth of their own: each begins with the first two detections in a row that are on its
/// person, and is then alone. Every person knows the past alone; the detector has seen the scene before,
/// with other people in it, as one that has run for a while.
OutlineExperiment run_outline_experiment(const OutlineExperimentOptions& options, const Hooks& hooks = {});

/// A table a case.
std::string to_text(const OutlineExperiment& experiment);

/// One table in Markdown, a row a case: IoU, centre error and names lost of each method.
std::string to_markdown(const OutlineExperiment& experiment);

}  // namespace marey::experiments

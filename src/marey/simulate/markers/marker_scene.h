#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/source.h"

namespace marey::simulate::markers {

/// The situations in which the OpenMoCap paper compares its trackers (§IV-A), and plain motion for its timing (§IV-B).
enum class MarkerSituation {
  slow_zigzag,
  rapid_zigzag,
  acceleration,
  occlusion,  ///< one marker passes behind a barrier, on a straight or a bent path
  crossing,   ///< the paper's marker swapping: two markers meet and part
  bar,        ///< one marker, nearly straight, 12 to 32 frames behind a bar of any grey that crosses the image
  opposite,   ///< the same with two, from opposite sides, hidden at the same time in one lane
  plain,      ///< smooth curves that every tracker can track: for timing
};

/// All situations with the names that the command line uses.
struct NamedSituation {
  std::string_view name;
  MarkerSituation situation;
};
std::span<const NamedSituation> marker_situations();

struct MarkerSceneOptions {
  cv::Size size{640, 480};     ///< px
  double rate_hz = 30;         ///< frames a second
  std::optional<int> frames;   ///< nothing: as long as the paper's samples say (86, 55; 90 where they do not)
  std::optional<int> markers;  ///< nothing: as many as the situation needs; further ones move plainly
  double radius_px = 5;        ///< of every marker's disc
  double blur_px = 0.55;       ///< standard deviation of the disc's edge
  double noise = 1.5;          ///< standard deviation of the pixels, grey levels
  int clutter = 0;             ///< false lights a frame, each in a new place
  int bars = 1;                ///< that markers pass behind one after the other: in bar and opposite
  double pace = 1;             ///< in bar and opposite: everything takes 1 / pace of the frames; positive
};

/// Where a marker truly is in one frame.
struct MarkerTruth {
  int marker = 0;                          ///< 0, 1, …
  Vector<2> position = Vector<2>::Zero();  ///< px
  bool visible = true;                     ///< its centre is neither behind a barrier nor outside the image
};

/// A scene of moving markers whose truth is known.
struct MarkerScene {
  MarkerSituation situation{};
  MarkerSceneOptions options;
  std::uint64_t seed = 0;
  std::vector<std::vector<MarkerTruth>> frames;
  std::vector<std::vector<Vector<2>>> clutter;  ///< px, by frame
  std::vector<Box> barriers;                    ///< px; they hide what is behind them
  double barrier_level = 34;                    ///< grey level
};

/// Draws one video of a situation from `seed`: the same one on every machine.
/// The paper leaves the speeds open. Ours were chosen, and then frozen, so that its alpha-beta and Kalman filters err by what its
/// tables II–IV say; `docs/reference/experiments.md` shows both.
MarkerScene simulate_markers(MarkerSituation situation, std::uint64_t seed, const MarkerSceneOptions& options = {});

/// Frame `index` of the scene as a camera gives it: CV_8UC1. Bright discs over a dark ground, each before those of lower number,
/// barriers before all of them; the noise follows from the scene's seed.
cv::Mat render_frame(const MarkerScene& scene, int index);

/// The scene as a camera gives it.
std::unique_ptr<Source> make_source(MarkerScene scene);

}  // namespace marey::simulate::markers

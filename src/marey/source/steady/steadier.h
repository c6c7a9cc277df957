#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/source.h"
#include "marey/source/steady/standing_scene.h"

namespace marey::source::steady {

/// What became of a camera's pictures, written by who steadies them and read by others, at any time.
class SteadyLog {
 public:
  /// A camera that was turned, and stayed so.
  struct Bump {
    double time = 0;   ///< s by the source's clock, about
    double by_px = 0;  ///< of the picture's middle
  };
  struct Report {
    std::int64_t pictures = 0, lost = 0;
    double rms_px = 0, most_px = 0;  ///< how far places of the picture were from their rest, the mean of four places
    std::optional<Bump> bump;
    std::optional<double> lost_since_s;  ///< none of the pictures since, to the end, for ten seconds or more
  };

  void add(const Frame& frame, const std::optional<SceneMotion>& motion, const PinholeView& view, cv::Size size);
  /// Whether this picture could not be steadied; it is asked once a picture.
  bool was_lost(std::int64_t index);
  Report report() const;

 private:
  mutable std::mutex writing_;
  std::set<std::int64_t> lost_;
  Report counts_;
  double squares_ = 0, last_time_ = 0;
  std::optional<double> lost_from_;
  struct Second {
    double time = 0;
    Vector<2> sum = Vector<2>::Zero();
    int count = 0;
  };
  std::vector<Second> seconds_;  // where the picture's middle was, on average
};

/// One sentence on how much the camera moved, and warnings of what the user should know.
std::string said(const SteadyLog::Report& report);
std::vector<std::string> warned(const SteadyLog::Report& report);

/// Brings pictures of a camera that shakes to where it rests.
class Steadier {
 public:
  Steadier(StandingScene scene, std::shared_ptr<SteadyLog> log) : scene_(std::move(scene)), log_(std::move(log)) {}

  /// The picture as the camera at rest would show it. What it does not show there is as it was shown last; before that, as the edge
  /// is. A picture that cannot be steadied comes back as it is, and the log says so. Frames come in order.
  Frame steadied(Frame frame);

 private:
  StandingScene scene_;
  std::shared_ptr<SteadyLog> log_;
  Picture last_;
};

/// The same source, steadied, without the pictures that cannot be: their time passes.
std::unique_ptr<Source> steadied(std::unique_ptr<Source> source, StandingScene scene, std::shared_ptr<SteadyLog> log);

/// How far the camera moved between pictures, px root mean square; nothing where that cannot be told.
std::optional<double> motion_among(std::span<const Frame> samples);

}  // namespace marey::source::steady

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
#include "marey/source/stabilise/reference_scene.h"

namespace marey::source::stabilise {

/// What happened to a camera's images, written by who stabilises them and read by others, at any time.
class StabilisationLog {
 public:
  /// A camera that was turned, and stayed so.
  struct Bump {
    double time = 0;   ///< s by the source's clock, about
    double by_px = 0;  ///< of the image's middle
  };
  struct Report {
    std::int64_t images = 0, lost = 0;
    double rms_px = 0, max_px = 0;  ///< how far places of the image were from their rest, the mean of four places
    std::optional<Bump> bump;
    std::optional<double> lost_since_s;  ///< none of the images since, to the end, for ten seconds or more
  };

  void add(const Frame& frame, const std::optional<SceneMotion>& motion, const PinholeView& view, cv::Size size);
  /// Whether this image could not be stabilised; it is asked once an image.
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
  std::vector<Second> seconds_;  // where the image's middle was, on average
};

/// One sentence on how much the camera moved, and warnings of what the user should know.
std::string stated(const StabilisationLog::Report& report);
std::vector<std::string> warned(const StabilisationLog::Report& report);

/// Brings images of a shaking camera to where it rests.
class Stabiliser {
 public:
  Stabiliser(ReferenceScene scene, std::shared_ptr<StabilisationLog> log) : scene_(std::move(scene)), log_(std::move(log)) {}

  /// The image as the camera at rest would show it. What it does not show there is as it was shown last; before that, as the edge
  /// is. An image that cannot be stabilised comes back as it is, and the log says so. Frames come in order.
  Frame stabilised(Frame frame);

 private:
  ReferenceScene scene_;
  std::shared_ptr<StabilisationLog> log_;
  Image last_;
};

/// The same source, stabilised, without the images that cannot be: their time passes.
std::unique_ptr<Source> stabilised(std::unique_ptr<Source> source, ReferenceScene scene, std::shared_ptr<StabilisationLog> log);

/// How far the camera moved between images, px root mean square; nothing if that cannot be reported.
std::optional<double> motion_among(std::span<const Frame> samples);

}  // namespace marey::source::stabilise

#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include <opencv2/core.hpp>

#include "marey/core/foreground.h"
#include "marey/core/frame.h"
#include "marey/core/geometry.h"

namespace marey::detect::background {

/// A model of the empty scene of a fixed camera.
class Background {
 public:
  virtual ~Background() = default;

  /// Begins with the scene common to `samples`, which span some seconds of the recording; people may stand in any of them.
  /// May be omitted: the model then begins with the first frame it is given.
  virtual void prime(std::span<const Frame> /*samples*/) {}

  /// What in `frame` does not belong to the scene; then learns from it, except within `held`, where people are known to be.
  /// Frames come in the order of their time. Where their size changes, the model begins again. The mask returned is valid
  /// until the next call.
  virtual Foreground apply(const Frame& frame, std::span<const Box> held) = 0;

  /// The empty scene as it is trusted to be now; empty if the model does not specify.
  virtual Image scene() const { return {}; }
  /// The same within `part`, whose corner is on even pixels.
  virtual Image scene(const cv::Rect& part) const {
    const Image whole = scene();
    return whole.empty() ? whole : whole.part(part);
  }

  /// What the image shows where `mask` (CV_8UC1, its upper left pixel at `corner` of the image) is not 0 is the scene:
  /// something that was taken for a part of it has gone. A model that does not specify its scene need not know.
  virtual void trust(const Image& /*image*/, const cv::Mat& /*mask*/, cv::Point /*corner*/) {}
};

/// Marey's own model: background_adaptive.cpp explains it.
struct AdaptiveOptions {
  static constexpr std::string_view name = "marey";

  double sensitivity = 1;      ///< divides every threshold: 2 finds what differs half as much, and more noise with it
  double memory_s = 6;         ///< s; the scene's slow changes are followed with this time constant
  double absorb_after_s = 90;  ///< s; what stands still this long and is held by no target belongs to the scene
  bool suppress_shadows = true;
};

/// OpenCV's mixture of Gaussians (Zivkovic 2004), with OpenCV's defaults. Shadows it finds do not count as foreground.
struct Mog2Options {
  static constexpr std::string_view name = "mog2";

  int history = 500;          ///< frames
  double variance_gate = 16;  ///< squared Mahalanobis distance
  bool detect_shadows = true;
};

/// OpenCV's K nearest neighbours (Zivkovic & van der Heijden 2006), with OpenCV's defaults.
struct KnnOptions {
  static constexpr std::string_view name = "knn";

  int history = 500;              ///< frames
  double squared_distance = 400;  ///< squared levels
  bool detect_shadows = true;
};

/// Every background model there is: a new one is added here, and the compiler names the places that must know it.
using BackgroundOptions = std::variant<AdaptiveOptions, Mog2Options, KnnOptions>;

std::unique_ptr<Background> make_background(const BackgroundOptions& options = {});

/// The models' names with commas between, the default one first.
std::string background_names();

/// The default options of the model called `name`. Throws Error with the list of names where there is no such model.
BackgroundOptions parse_background(std::string_view name);

}  // namespace marey::detect::background

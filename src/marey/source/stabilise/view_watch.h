// Whether a camera that ought to stand does, found out from its images as they pass: that it shakes, is turned or zooms, that the
// video is cut, that it shows a screen that is scrolled. Cheap enough to check every recording, live ones too: images are
// shrunk to a few hundred pixels across, corners are followed three times a second, and what a cut changes is asked of each image
// at 32 pixels across.
#pragma once

#include <cstdint>
#include <iterator>
#include <optional>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/frame.h"
#include "marey/core/image.h"
#include "marey/source/stabilise/scene_motion.h"

namespace marey::source::stabilise {

/// What a camera did, as far as its images show.
struct ViewReport {
  /// A camera that was turned, or zoomed.
  struct Turn {
    double from_s = 0, to_s = 0;  ///< by the source's clock, about
    double fraction = 0;          ///< of the image's width that its middle has moved
    double zoom = 1;              ///< how much larger the scene is seen at the end, or smaller
    bool stays = false;           ///< it moved for a moment only, and stood before and after
  };
  std::vector<double> cuts;  ///< s: from here on another scene is shown
  std::optional<Turn> turn;  ///< the first, and how far it went in all
  double shake_px = 0;       ///< root mean square, px of the whole image, about where the camera stood of late
  double scrolling = 0;  ///< share of the measured images in which a part moves upwards or downwards as one, while the rest stands
  std::int64_t images = 0;  ///< images whose motion is known
};

class ViewWatch {
 public:
  /// Frames come in the order of their time; of one camera.
  void add(const Frame& frame);
  ViewReport report() const;
  /// The same as in the report, which takes longer.
  const std::vector<double>& cuts() const { return cuts_; }
  std::int64_t images() const { return std::ssize(locations_); }

 private:
  /// How far the scene has moved at the image's middle, shrunk px, and how much larger it is seen, ln.
  struct Shift {
    Vector<2> middle = Vector<2>::Zero();
    double log_scale = 0;

    Shift operator+(const Shift& more) const { return {middle + more.middle, log_scale + more.log_scale}; }
  };
  struct View {
    cv::Mat small;
    std::vector<cv::Mat> pyramid;
    std::vector<cv::Point2f> corners;
    Shift at;  ///< since the segment's first image
  };
  struct Location {
    double time = 0;
    Shift at;
    int segment = 0;
  };

  void begin(const cv::Mat& small, double time);
  bool was_cut(const Image& image, double time);
  bool shows_another_scene(const Image& image);
  void track_scene(const cv::Mat& small, double time);
  struct Motion {
    Shift by;
    double fraction = 0;  ///< of all corners, which agree
    std::vector<TrackedPosition> locations;
  };
  std::optional<Motion> moved(View& from, const std::vector<cv::Mat>& pyramid) const;
  void note(const Shift& at, double time);
  bool scrolls(const std::vector<TrackedPosition>& locations, const Shift& motion) const;

  cv::Size size_;       // of the images
  double shrink_ = 1;   // px of the image in one of a shrunk one
  PinholeView lens_;    // shrunk
  View anchor_, last_;  // what images are compared with first; the last one whose motion was known
  Image previous_;
  cv::Mat previous_thumb_;
  double typical_change_ = 0, previous_change_ = 0;
  std::optional<double> possible_cut_s_;  // when the last image came, where it may be the first of another scene
  double next_s_ = 0, lost_since_s_ = -1;
  int segment_ = 0;
  std::vector<double> cuts_;
  std::vector<Location> locations_;
  std::int64_t scrolled_ = 0;
};

}  // namespace marey::source::stabilise

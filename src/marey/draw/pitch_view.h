#pragma once

#include <optional>
#include <span>
#include <string>

#include "marey/core/geometry.h"
#include "marey/core/image.h"
#include "marey/core/time.h"
#include "marey/draw/canvas.h"
#include "marey/draw/fading_trails.h"
#include "marey/geometry/pitch.h"

namespace marey::draw {

struct PitchViewOptions {
  std::optional<geometry::PitchSize> pitch = {};  ///< nothing: a grid of 5 m is drawn in place of the lines
  Vector<2> low = {-3, -3};                       ///< m; the part of the ground that is shown
  Vector<2> high = {108, 71};
  bool y_down = true;                        ///< of the image; else y grows upwards
  int width = 1280;                          ///< px; the height follows
  Duration trail = std::chrono::seconds(4);  ///< how long a trail takes to fade
};

/// The ground from above, as a radar shows it: the pitch's lines, a disc with a number for each person, hollow where no camera sees
/// the person, and a trail of where each was that fades with age. A person hidden by the image's border is not drawn.
class PitchView {
 public:
  struct Mark {
    int number = 0;    ///< whose, for the trail
    std::string text;  ///< on the disc
    Colour colour;
    Vector<2> location;  ///< m, in the coordinates of the pitch
    bool observed = true;
  };

  explicit PitchView(const PitchViewOptions& options);

  cv::Size size() const { return ground_.size(); }

  /// Instants come in order. Keeps trails of those alone who were there within `trail`.
  Image draw(Timestamp now, std::span<const Mark> marks);

 private:
  cv::Point2f pixel(const Vector<2>& location) const;
  void draw_ground();

  PitchViewOptions options_;
  double scale_;  ///< px/m
  Image ground_;  ///< without people
  FadingTrails trails_;
};

}  // namespace marey::draw

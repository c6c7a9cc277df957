#pragma once

#include <deque>
#include <map>

#include "marey/core/time.h"
#include "marey/draw/canvas.h"

namespace marey::draw {

/// Where things were, as lines that fade with age.
class FadingTrails {
 public:
  /// `lasts`: after this long a place is forgotten.
  explicit FadingTrails(Duration lasts) : lasts_(lasts) {}

  /// The thing of this number is at `place` (px) now. A trail is drawn in the colour given last.
  void add(int number, Timestamp now, cv::Point2f location, const Colour& colour);

  /// `opacity` of what is new, in [0, 1]; `width` in px. A target not seen within `lasts` is forgotten.
  void draw(Canvas& canvas, Timestamp now, double opacity, double width);

 private:
  struct Step {
    Timestamp time;
    cv::Point2f location;
  };
  struct Trail {
    Colour colour;
    std::deque<Step> steps;
  };

  Duration lasts_;
  std::map<int, Trail> trails_;
};

}  // namespace marey::draw

#include "marey/draw/fading_trails.h"

#include <vector>

namespace marey::draw {

void FadingTrails::add(int number, Timestamp now, cv::Point2f location, const Colour& colour) {
  Trail& trail = trails_[number];
  trail.colour = colour;
  trail.steps.push_back({now, location});
}

void FadingTrails::draw(Canvas& canvas, Timestamp now, double opacity, double width) {
  std::vector<Canvas::Stroke> strokes;
  for (auto trail = trails_.begin(); trail != trails_.end();) {
    auto& [colour, steps] = trail->second;
    while (!steps.empty() && now - steps.front().time > lasts_) steps.pop_front();
    if (steps.empty()) {
      trail = trails_.erase(trail);
      continue;
    }
    strokes.clear();
    for (std::size_t i = 1; i < steps.size(); ++i) {
      const double age = seconds(now - steps[i].time) / seconds(lasts_);
      strokes.push_back({steps[i - 1].location, steps[i].location, opacity * (1 - age)});
    }
    canvas.strokes(strokes, colour, width);
    ++trail;
  }
}

}  // namespace marey::draw

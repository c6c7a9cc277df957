#include "marey/track/tracker.h"

#include <variant>

#include "marey/core/error.h"
#include "marey/track/image/filter_tracker.h"

namespace marey::track {
namespace {

void check(bool good, const char* name, double value, const char* domain) {
  if (!good) throw Error("the tracker's {} is {}; it must be {}", name, value, domain);
}

void check(const TrackerOptions& o) {
  check(o.gate_probability > 0 && o.gate_probability < 1, "gate_probability", o.gate_probability, "between 0 and 1");
  check(o.max_speed > 0, "max_speed", o.max_speed, "positive");
  check(o.position_noise > 0, "place_noise", o.position_noise, "positive");
  check(o.size_noise > 0, "size_noise", o.size_noise, "positive");
  check(o.size_drift >= 0, "size_drift", o.size_drift, "0 or more");
  check(o.fading > 0, "fading", o.fading, "positive");
  check(o.patience >= 0, "patience", o.patience, "0 or more");
  check(o.hidden_patience >= 0, "hidden_patience", o.hidden_patience, "0 or more");
}

}  // namespace

TrackerOptions box_tracker_options(TrackerOptions options) {
  const TrackerOptions typical;
  const auto* usual_filter = std::get_if<filter::KalmanOptions>(&typical.filter);
  auto* kalman = std::get_if<filter::KalmanOptions>(&options.filter);
  if (kalman != nullptr && usual_filter != nullptr && kalman->acceleration_noise == usual_filter->acceleration_noise)
    kalman->acceleration_noise = 0.15;
  if (options.position_noise == typical.position_noise) options.position_noise = 0.05;
  if (options.size_noise == typical.size_noise) options.size_noise = 0.2;
  if (options.fading == typical.fading) options.fading = 2.5;
  options.learn_noise = true;
  return options;
}

TrackerOptions point_tracker_options() {
  TrackerOptions options;
  options.filter = filter::KalmanOptions{};
  options.max_speed = 5000;
  return options;
}

std::unique_ptr<Tracker<2>> make_tracker(const TrackerOptions& options) {
  check(options);
  return std::make_unique<image::FilterTracker>(options);
}

}  // namespace marey::track

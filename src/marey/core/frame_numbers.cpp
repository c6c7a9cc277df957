#include "marey/core/frame_numbers.h"

#include <algorithm>
#include <cmath>

#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey {
namespace {

constexpr std::size_t kMaxSteps = 100'000;
constexpr double kAgree = 0.5;  // of the median step

}  // namespace

void FrameNumbers::add(std::int64_t frame, std::optional<double> time) {
  if (count_ > 0 && frame == here_) return;
  if (count_ > 0 && time && time_ && steps_.size() < kMaxSteps) {
    const auto frames = static_cast<double>(frame - here_);
    const double step = *time - *time_;
    if (step / frames > 0 && std::isfinite(step)) steps_.emplace_back(std::abs(frames), std::abs(step));
  }
  first_ = count_ == 0 ? frame : std::min(first_, frame);
  last_ = count_ == 0 ? frame : std::max(last_, frame);
  here_ = frame, time_ = time;
  ++count_;
}

void FrameNumbers::check(std::string_view name) const {
  if (last_ - first_ - count_ <= kMaxMissing) return;
  throw Error("{}: frames {} to {} are named, of which {} are there; a number must be wrong", name, first_, last_, count_);
}

std::optional<double> FrameNumbers::rate_hz() const {
  if (steps_.empty()) return std::nullopt;
  std::vector<double> each;
  each.reserve(steps_.size());
  for (const auto& [frames, step] : steps_) each.push_back(step / frames);
  const auto middle = geometry::median(each);
  double frames_in_all = 0, time_in_all = 0;
  for (const auto& [frames, step] : steps_) {
    if (std::abs(step / frames - middle) > kAgree * middle) continue;
    frames_in_all += frames;
    time_in_all += step;
  }
  const double rate = frames_in_all / time_in_all;
  return std::isfinite(rate) && rate > 0 ? std::optional(rate) : std::nullopt;
}

}  // namespace marey

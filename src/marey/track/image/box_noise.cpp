#include "marey/track/image/box_noise.h"

#include <algorithm>
#include <cmath>

namespace marey::track::image {
namespace {

// bench/tuning.md has the sweep of those that follow.
constexpr double kNearSpan = 0.2, kFarSpan = 0.48;  // s
constexpr double kFirstCount = 300;                 // differences that the first levels count for
constexpr double kMaxCounted = 4000;                // differences that are remembered
constexpr double kMinSquare = 1e-8;                 // of a difference, numerical: a power of 0
constexpr double kOutlier = 9;                      // times the mean
// Levels beyond these are not people's.
constexpr double kMinPosition = 0.003, kMaxPosition = 0.15;
constexpr double kMinAcceleration = 0.1, kMaxAcceleration = 3;
constexpr double kMinSize = 0.01, kMaxSize = 0.3;
constexpr double kMinDrift = 0.05, kMaxDrift = 1;

double cube(double h) {
  return h * h * h;
}

double position_difference(const BoxNoiseLevels& levels, double span) {
  return 6 * levels.location * levels.location + 2.0 / 3 * levels.acceleration * levels.acceleration * cube(span);
}

double size_difference(const BoxNoiseLevels& levels, double span) {
  return 2 * levels.size * levels.size + levels.drift * levels.drift * span;
}

/// That many seconds in frames, of which a trail holds `most` at least twice over.
std::size_t frames_in(double span, double dt, std::size_t minimum) {
  const double frames = std::min(span / dt, static_cast<double>(BoxTrail::kLength));
  return std::clamp(static_cast<std::size_t>(std::lround(frames)), minimum, (BoxTrail::kLength - 1) / 2);
}

std::size_t near_frames(double dt) {
  return std::min(frames_in(kNearSpan, dt, 1), (BoxTrail::kLength - 1) / 4);
}

std::size_t far_frames(double dt) {
  return frames_in(kFarSpan, dt, near_frames(dt) + 1);
}

double root_within(double variance, double minimum, double maximum) {
  return std::clamp(std::sqrt(std::max(0.0, variance)), minimum, maximum);
}

}  // namespace

void BoxTrail::add(const Box& box) {
  Entry& entry = entries_[next_++ % kLength];
  entry.detected = !box.empty();
  if (!entry.detected) return;
  entry.centre = box.centre();
  entry.log_size = {std::log(box.width), std::log(box.height)};
}

const BoxTrail::Entry* BoxTrail::back(std::size_t frames) const {
  if (frames >= kLength || frames >= next_) return nullptr;
  const Entry& entry = entries_[(next_ - 1 - frames) % kLength];
  return entry.detected ? &entry : nullptr;
}

void BoxNoise::Differences::MeanSquare::add(double square, double first) {
  square = std::min(square, kOutlier * with(first));
  count = std::min(count + 1, kMaxCounted);
  value += (square - value) / count;
}

double BoxNoise::Differences::MeanSquare::with(double first) const {
  const double weight = recording_weight();
  return weight * value + (1 - weight) * first;
}

/// 1 where the memory is full of the recording itself.
double BoxNoise::Differences::MeanSquare::recording_weight() const {
  return count / (count + kFirstCount * (1 - count / kMaxCounted));
}

/// The geometric mean of both.
double BoxNoise::Differences::MeanSquare::soon_with(double first) const {
  const double weight = recording_weight();
  return std::pow(std::max(value, kMinSquare), weight) * std::pow(first, 1 - weight);
}

void BoxNoise::Differences::add(const BoxTrail& trail, std::size_t frames, double dt, const BoxNoiseLevels& first) {
  const BoxTrail::Entry *now = trail.back(0), *middle = trail.back(frames), *before = trail.back(2 * frames);
  if (now == nullptr || middle == nullptr) return;
  const double span = static_cast<double>(frames) * dt;
  size_.add((now->log_size - middle->log_size).squaredNorm() / 2, size_difference(first, span));
  if (before == nullptr) return;
  const Vector<2> bend = (now->centre - 2 * middle->centre + before->centre) / std::exp(now->log_size.y());
  location_.add(bend.squaredNorm() / 2, position_difference(first, span));
}

double BoxNoise::Differences::location(const BoxNoiseLevels& first, double span, Trust trust) const {
  const double before = position_difference(first, span);
  return trust == Trust::soon ? location_.soon_with(before) : location_.with(before);
}

double BoxNoise::Differences::size(const BoxNoiseLevels& first, double span, Trust trust) const {
  const double before = size_difference(first, span);
  return trust == Trust::soon ? size_.soon_with(before) : size_.with(before);
}

void BoxNoise::observe_frame(const BoxTrail& trail, double dt) {
  if (dt <= 0) return;
  dt_ = dt;
  frame_.add(trail, 1, dt, first_);
  two_frames_.add(trail, 2, dt, first_);
  near_.add(trail, near_frames(dt), dt, first_);
  far_.add(trail, far_frames(dt), dt, first_);
}

/// Two distances, two unknowns, for places and for sizes.
BoxNoiseLevels BoxNoise::solved(const Differences& shorter, double near, const Differences& longer, double far, Trust trust) const {
  const double place_near = shorter.location(first_, near, trust), place_far = longer.location(first_, far, trust);
  const double q = std::max(0.0, (place_far - place_near) * 1.5 / (cube(far) - cube(near)));
  const double size_near = shorter.size(first_, near, trust), size_far = longer.size(first_, far, trust);
  const double d = std::max(0.0, (size_far - size_near) / (far - near));
  return {.location = root_within((place_near - 2.0 / 3 * q * cube(near)) / 6, kMinPosition, kMaxPosition),
          .acceleration = root_within(q, kMinAcceleration, kMaxAcceleration),
          .size = root_within((size_near - d * near) / 2, kMinSize, kMaxSize),
          .drift = root_within(d, kMinDrift, kMaxDrift)};
}

BoxNoiseLevels BoxNoise::levels(Trust trust) const {
  if (dt_ <= 0) return first_;
  return solved(near_, static_cast<double>(near_frames(dt_)) * dt_, far_, static_cast<double>(far_frames(dt_)) * dt_, trust);
}

/// At rates so low that a frame is as long as the shorter distance, nothing is known to last.
BoxNoiseLevels BoxNoise::levels_of_a_frame(Trust trust) const {
  if (dt_ <= 0 || near_frames(dt_) == 1) return levels(trust);
  BoxNoiseLevels levels = solved(frame_, dt_, near_, static_cast<double>(near_frames(dt_)) * dt_, trust);
  const BoxNoiseLevels shortest = solved(frame_, dt_, two_frames_, 2 * dt_, trust);  // over which poses change smoothly
  levels.location = std::min(levels.location, shortest.location);
  levels.size = std::min(levels.size, shortest.size);
  return levels;
}

LastingFractions lasting_fractions(const BoxNoise& noise) {
  const BoxNoiseLevels frame = noise.levels_of_a_frame(BoxNoise::Trust::soon), all = noise.levels(BoxNoise::Trust::soon);
  const auto fraction = [](double of_a_frame, double in_all) {
    return std::max(0.0, 1 - of_a_frame * of_a_frame / (in_all * in_all));
  };
  return {fraction(frame.location, all.location), fraction(frame.size, all.size)};
}

Box written_box(const Box& filtered, const Box& detected, const LastingFractions& fractions) {
  const Vector<2> centre = filtered.centre() + fractions.location * (detected.centre() - filtered.centre());
  const auto side = [&](double before, double as_seen) { return before * std::pow(as_seen / before, fractions.size); };
  return Box::from_centre(centre, side(filtered.width, detected.width), side(filtered.height, detected.height));
}

}  // namespace marey::track::image

#include "marey/format/keypoints/sequence_builder.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/files/text_safety.h"

namespace marey::format::keypoints {
namespace {

constexpr double kMaxPixel = 1e6;
// Standard deviation of a point of full confidence, as a share of the diagonal of the person's points: 8 px of a person 590 px
// tall. The one who needs more learns it from how well several views agree.
constexpr double kNoiseFraction = 0.012;
constexpr double kMinNoise = 0.5;        // px
constexpr double kMinConfidence = 0.05;  // below, the noise does not grow any more
constexpr int kAppearance = 400;         // people by which a set is distinguished from another one

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// The noise of a point of full confidence.
double noise_of(const Keypoints<2>& person) {
  Vector<2> low = Vector<2>::Constant(kMaxPixel), high = -low;
  for (const auto& point : person.points) {
    if (!point) continue;
    low = low.cwiseMin(point->position);
    high = high.cwiseMax(point->position);
  }
  return std::max(kMinNoise, kNoiseFraction * (high - low).norm());
}

}  // namespace

std::int64_t frame_number_in(std::string_view name) {
  std::size_t best = 0, length = 0;
  for (std::size_t i = 0; i < name.size();) {
    std::size_t end = i;
    while (end < name.size() && is_digit(name[end])) ++end;
    if (end > i && end - i >= length) {
      best = i;
      length = end - i;
    }
    i = std::max(end, i + 1);
  }
  std::int64_t number = -1;
  const auto result = std::from_chars(name.data() + best, name.data() + best + length, number);
  return length > 0 && result.ec == std::errc() ? number : -1;
}

void SequenceBuilder::add_frame(std::int64_t frame, std::optional<double> time_s) {
  if (frame < 0) throw Error("{}: frame {} is negative; frames count from 0 or 1", sequence_.from, frame);
  numbers_.add(frame, time_s);
  last_frame_ = std::max(last_frame_, frame);
}

void SequenceBuilder::add(std::int64_t frame, const std::vector<FilePoint>& points, double score, const std::string& where) {
  if (points_ == 0) points_ = points.size();
  if (points.empty()) return;
  if (points.size() != points_)
    throw Error("{}: a person has {} points and another one {}; all must be of one keypoint set", where, points.size(), points_);
  Keypoints<2> person;
  person.points.resize(points.size());
  person.presence = std::clamp(score, 0.0, 1.0);
  bool any = false;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const FilePoint& point = points[i];
    if (!(point.confidence > 0)) continue;
    if (!(std::abs(point.x) < kMaxPixel && std::abs(point.y) < kMaxPixel))
      throw Error("{}: point {} lies at ({}, {}), which is not a place in an image; a missing point has the confidence 0", where,
                  i + 1, point.x, point.y);
    person.points[i] = Keypoint<2>{.position = {point.x, point.y}, .visibility = std::min(1.0, point.confidence)};
    any = true;
  }
  add_frame(frame);
  if (!any) return;
  const double noise = noise_of(person);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!person.points[i]) continue;
    const double typical = noise / std::sqrt(std::max(kMinConfidence, person.points[i]->visibility));
    const double sigma = points[i].sigma ? std::hypot(*points[i].sigma, noise) : typical;
    person.points[i]->covariance = sigma * sigma * Matrix<2>::Identity();
  }
  people_.push_back({frame, std::move(person)});
}

void SequenceBuilder::name_points(const std::vector<std::string>& names) {
  std::vector<std::string> common;
  for (const std::string& name : names) {
    common.push_back(common_keypoint_name(plain_text(name)));
    if (std::count(common.begin(), common.end(), common.back()) > 1)
      throw Error("{}: two keypoints are called {}", sequence_.from, common.back());
  }
  sequence_.set = keypoint_set_of("of the file", common);
  for (const KeypointSet& known : keypoint_sets()) {
    if (known.points == common) sequence_.set = known;
  }
}

double SequenceBuilder::mean_bone(const KeypointSet& set) const {
  double sum = 0, count = 0;
  for (std::size_t p = 0; p < people_.size(); p += std::max<std::size_t>(1, people_.size() / kAppearance)) {
    const auto& points = people_[p].keypoints.points;
    for (const auto& [a, b] : set.bones) {
      const auto &from = points[static_cast<std::size_t>(a)], &to = points[static_cast<std::size_t>(b)];
      if (!from || !to) continue;
      sum += (from->position - to->position).norm();
      ++count;
    }
  }
  return count > 0 ? sum / count : 0;
}

void SequenceBuilder::choose_set(std::string_view set) {
  if (!set.empty()) {
    const KeypointSet& named = keypoint_set_named(set);
    if (points_ != 0 && named.points.size() != points_)
      throw Error("{}: a person has {} points; keypoint set {} has {}", sequence_.from, points_, named.name, named.points.size());
    sequence_.set = named;
    return;
  }
  if (!sequence_.set.points.empty()) {
    if (points_ != 0 && sequence_.set.points.size() != points_)
      throw Error("{}: a person has {} points, and {} are named", sequence_.from, points_, sequence_.set.points.size());
    return;
  }
  const KeypointSet* best = nullptr;
  double shortest = 0;
  for (const KeypointSet& known : keypoint_sets()) {
    if (known.points.size() != points_) continue;
    const double length = mean_bone(known);
    if (best == nullptr || length < shortest) {
      best = &known;
      shortest = length;
    }
  }
  if (best == nullptr && points_ == 0) return;
  if (best == nullptr)
    throw Error("{}: a person has {} points, as no known keypoint set does; there are {}", sequence_.from, points_,
                keypoint_set_names());
  sequence_.set = *best;
}

KeypointSequence SequenceBuilder::finish(std::string_view set) {
  numbers_.check(sequence_.from);
  if (!sequence_.rate_hz) sequence_.rate_hz = numbers_.rate_hz();
  choose_set(set);
  sequence_.frames.resize(static_cast<std::size_t>(last_frame_ + 1));
  for (Person& person : people_) sequence_.frames[static_cast<std::size_t>(person.frame)].push_back(std::move(person.keypoints));
  people_.clear();
  return std::move(sequence_);
}

}  // namespace marey::format::keypoints

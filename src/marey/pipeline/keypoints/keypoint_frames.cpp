#include "marey/pipeline/keypoints/keypoint_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace marey::pipeline::keypoints {
namespace {

constexpr double kSameTimeStep = 0.02;  // of a frame
constexpr double kSamePersonPx = 0.3;   // mean distance of points from frame to frame, of the person's extent

double extent_of(const Keypoints<2>& person) {
  Vector<2> low = Vector<2>::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& point : person.points) {
    if (!point) continue;
    low = low.cwiseMin(point->position);
    high = high.cwiseMax(point->position);
  }
  return (high - low).norm();
}

std::optional<double> distance_between(const Keypoints<2>& a, const Keypoints<2>& b) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (!a.points[i] || !b.points[i]) continue;
    sum += (a.points[i]->position - b.points[i]->position).norm();
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

Keypoints<2> blended(const Keypoints<2>& earlier, const Keypoints<2>& later, double fraction) {
  Keypoints<2> person = fraction < 0.5 ? earlier : later;
  for (std::size_t i = 0; i < person.points.size(); ++i) {
    if (!earlier.points[i] || !later.points[i]) continue;
    const Keypoint<2>&a = *earlier.points[i], &b = *later.points[i];
    Keypoint<2>& point = *person.points[i];
    point.position = (1 - fraction) * a.position + fraction * b.position;
    point.covariance = (1 - fraction) * a.covariance + fraction * b.covariance;
    point.visibility = (1 - fraction) * a.visibility + fraction * b.visibility;
  }
  return person;
}

}  // namespace

std::vector<Keypoints<2>> between_frames(const std::vector<Keypoints<2>>& earlier, const std::vector<Keypoints<2>>& later,
                                         double fraction) {
  std::vector<Keypoints<2>> people;
  std::vector<char> taken(later.size(), 0);
  for (const Keypoints<2>& person : earlier) {
    double nearest = kSamePersonPx * extent_of(person);
    std::size_t same = later.size();
    for (std::size_t j = 0; j < later.size(); ++j) {
      const auto distance = distance_between(person, later[j]);
      if (taken[j] != 0 || !distance || *distance >= nearest) continue;
      nearest = *distance;
      same = j;
    }
    if (same < later.size()) {
      taken[same] = 1;
      people.push_back(blended(person, later[same], fraction));
    } else if (fraction < 0.5) {
      people.push_back(person);
    }
  }
  for (std::size_t j = 0; j < later.size(); ++j) {
    if (taken[j] == 0 && fraction >= 0.5) people.push_back(later[j]);
  }
  return people;
}

KeypointFrames::KeypointFrames(const std::vector<std::optional<KeypointCamera>>& cameras) : cameras_(cameras.size()) {
  static const std::vector<Keypoints<2>> no_person;
  std::vector<double> firsts, lasts;
  for (const auto& camera : cameras) {
    if (!camera || camera->sequence.frames.empty()) continue;
    if (rate_hz_ == 0) rate_hz_ = camera->rate_hz;
    firsts.push_back(camera->first_s());
    lasts.push_back(camera->last_s());
  }
  if (firsts.empty()) return;
  const std::size_t second = std::min<std::size_t>(1, firsts.size() - 1);  // a single camera is by itself
  std::sort(firsts.begin(), firsts.end());
  std::sort(lasts.rbegin(), lasts.rend());
  // On the first camera's frames, from the second camera's beginning to the last but one's end.
  const auto first =
      std::find_if(cameras.begin(), cameras.end(), [](const auto& camera) { return camera && !camera->sequence.frames.empty(); });
  first_s_ = (*first)->first_s() + std::ceil((firsts[second] - (*first)->first_s()) * rate_hz_ - kSameTimeStep) / rate_hz_;
  const double count = std::floor((lasts[second] - first_s_) * rate_hz_ + kSameTimeStep) + 1;
  size_ = count > 0 ? static_cast<std::size_t>(count) : 0;
  people_.assign(size_ * cameras_, &no_person);
  for (std::size_t instant = 0; instant < size_; ++instant) {
    for (std::size_t c = 0; c < cameras_; ++c) {
      if (!cameras[c]) continue;
      const auto& frames = cameras[c]->sequence.frames;
      const double at = (time_s(instant) - cameras[c]->offset_s) * cameras[c]->rate_hz, nearest = std::round(at);
      if (nearest < 0 || nearest >= static_cast<double>(frames.size())) continue;
      const auto& now = frames[static_cast<std::size_t>(nearest)];
      people_[instant * cameras_ + c] = &now;
      if (std::abs(at - nearest) < kSameTimeStep) continue;
      const double begin = std::floor(at);
      if (begin < 0 || begin + 1 >= static_cast<double>(frames.size())) continue;
      const auto k = static_cast<std::size_t>(begin);
      people_[instant * cameras_ + c] = &moved_.emplace_back(between_frames(frames[k], frames[k + 1], at - begin));
    }
  }
}

}  // namespace marey::pipeline::keypoints

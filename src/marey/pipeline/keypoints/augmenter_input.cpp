#include "marey/pipeline/keypoints/augmenter_input.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "marey/core/keypoint_sets.h"
#include "marey/pipeline/keypoints/blazepose_hips.h"

namespace marey::pipeline::keypoints {
namespace {

// Indices, by definition of kAugmenterPoints and of AugmenterStep's order.
constexpr std::size_t kSides = 2;
constexpr std::size_t kHipPoint = 1, kAnklePoint = 3, kHeelPoint = 4, kSmallToePoint = 5, kBigToePoint = 6;
constexpr std::array<const char*, kSides> kSideNames = {"right_", "left_"};
/// Where OpenPose's small toe lies from heel and big toe, shares of their distance, by definition of Pose2Sim's markers for
/// body_25.
constexpr double kSmallToeAhead = 0.835, kSmallToeOutwards = 0.19;
/// From a hip's centre to where OpenPose has it, as the augmenter's networks themselves have learned that: their hips' centres lie
/// as far behind and below the keypoints that they are given (three walkers: 33 to 34 mm, 21 to 22 mm; 2 to 3 mm sideways).
constexpr double kHipAhead_m = 0.033, kHipUp_m = 0.021;  // bench/tuning.md

std::string prefix_of(const std::string& label) {
  return label.substr(0, label.find_last_of(':') + 1);
}

/// One side's point of the recording.
struct Track {
  const TrackColumns* columns = nullptr;
  std::optional<std::size_t> row_at(std::size_t instant) const {
    return columns == nullptr ? std::nullopt : columns->row_at(static_cast<std::int32_t>(instant));
  }
};

class PersonPoints {
 public:
  PersonPoints(const Recording& recording, const std::string& person, HipPoints hips)
      : joint_centres_(hips == HipPoints::joint_centres) {
    for (const TrackColumns& track : recording.tracks()) {
      if (prefix_of(track.name.label) != person) continue;
      const std::string name = common_keypoint_name(track.name.label.substr(person.size()));
      blaze_ = blaze_ || name == "left_eye_inner";
      for (std::size_t i = 0; i < tracks_.size(); ++i) {
        if (name == kSideNames[i % kSides] + std::string(kAugmenterPoints[i / kSides])) tracks_[i].columns = &track;
      }
    }
    small_toes_ = has(kSmallToePoint);
  }

  bool has(std::size_t point) const {
    const auto known = [](const Track& track) { return track.columns != nullptr && !track.columns->empty(); };
    return known(tracks_[kSides * point]) && known(tracks_[kSides * point + 1]);
  }
  bool small_toes() const { return small_toes_; }

  /// Whether the first `points` are known.
  bool complete(std::size_t instant, std::size_t points) const {
    for (std::size_t i = 0; i < kSides * points; ++i) {
      if (i / kSides == kSmallToePoint && !small_toes_) continue;
      if (!tracks_[i].row_at(instant)) return false;
    }
    return true;
  }

  /// Of an instant that is complete; arms that are not used stay 0. Notes where a covariance is absent.
  AugmenterStep at(std::size_t instant, std::size_t points, bool& covariances) const {
    AugmenterStep step;
    step.position.fill(Vector<3>::Zero());
    step.covariance.fill(Matrix<3>::Zero());
    for (std::size_t i = 0; i < kSides * points; ++i) {
      const auto row = tracks_[i].row_at(instant);
      if (!row) continue;
      const Sample sample = tracks_[i].columns->sample(*row);
      step.position[i] = sample.position;
      covariances = covariances && sample.covariance.has_value();
      if (sample.covariance) step.covariance[i] = *sample.covariance;
    }
    if (joint_centres_) {
      move_hips(step, {kHipAhead_m, 0, kHipUp_m});
    } else if (blaze_) {
      move_hips(step, {0, kBlazeHipInwards_m, kBlazeHipDown_m});
    }
    if (!small_toes_) add_small_toes(step);
    return step;
  }

 private:
  /// By this vector: ahead, outwards and up along the trunk.
  static void move_hips(AugmenterStep& step, const Vector<3>& by) {
    Vector<3>&right = step.position[kSides * kHipPoint], &left = step.position[kSides * kHipPoint + 1];
    const Vector<3> trunk = step.position[0] + step.position[1] - right - left, across = (left - right).normalized();
    const Vector<3> up = (trunk - across.dot(trunk) * across).normalized();
    if (!up.allFinite() || !across.allFinite()) return;
    const Vector<3> alike = by.x() * across.cross(up) + by.z() * up;
    right += alike - by.y() * across;
    left += alike + by.y() * across;
  }

  static void add_small_toes(AugmenterStep& step) {
    for (std::size_t side = 0; side < kSides; ++side) {
      const auto at = [&](std::size_t point) -> const Vector<3>& { return step.position[kSides * point + side]; };
      const Vector<3> foot = at(kBigToePoint) - at(kHeelPoint);
      const Vector<3> right = foot.cross(at(kAnklePoint) - at(kHeelPoint)).normalized();
      const double outwards = (side == 0 ? 1 : -1) * kSmallToeOutwards * foot.norm();
      step.position[kSides * kSmallToePoint + side] =
          at(kHeelPoint) + kSmallToeAhead * foot + (right.allFinite() ? Vector<3>(outwards * right) : Vector<3>::Zero().eval());
      step.covariance[kSides * kSmallToePoint + side] = step.covariance[kSides * kBigToePoint + side];
    }
  }

  std::array<Track, kSides * kAugmenterPoints.size()> tracks_;
  bool joint_centres_, blaze_ = false, small_toes_ = true;
};

AugmenterStep between(const AugmenterStep& a, const AugmenterStep& b, double fraction) {
  AugmenterStep step;
  for (std::size_t i = 0; i < step.position.size(); ++i) {
    step.position[i] = (1 - fraction) * a.position[i] + fraction * b.position[i];
    step.covariance[i] = (1 - fraction) * a.covariance[i] + fraction * b.covariance[i];
  }
  return step;
}

/// Instants `first` to `last` at even steps, straight between them.
AugmenterRun run_of(const Recording& recording, const PersonPoints& person, std::size_t points, std::size_t first, std::size_t last,
                    bool& covariances) {
  AugmenterRun run{.first = first, .last = last, .begin_s = recording.seconds_at(first), .steps = {}, .hips = {}};
  std::size_t at = first;
  AugmenterStep before = person.at(first, points, covariances), after = before;
  const double length = recording.seconds_at(last) - run.begin_s;
  for (std::size_t k = 0;; ++k) {
    const double now = static_cast<double>(k) / kAugmenterRate_hz;
    if (now > length + 1e-9) break;
    while (at < last && recording.seconds_at(at) - run.begin_s < now - 1e-9) {
      before = after;
      after = person.at(++at, points, covariances);
    }
    const double end = recording.seconds_at(at) - run.begin_s,
                 begin = at > first ? recording.seconds_at(at - 1) - run.begin_s : end;
    run.steps.push_back(end - begin > 0 ? between(before, after, std::clamp((now - begin) / (end - begin), 0.0, 1.0)) : after);
  }
  for (std::size_t t = first; t <= last; ++t) run.hips.push_back(hips_of(person.at(t, points, covariances)));
  return run;
}

}  // namespace

Vector<3> hips_of(const AugmenterStep& step) {
  return 0.5 * (step.position[kSides * kHipPoint] + step.position[kSides * kHipPoint + 1]);
}

AugmenterInput augmenter_input(const Recording& recording, const std::string& person, HipPoints hips, std::size_t min_steps) {
  const PersonPoints points(recording, person, hips);
  AugmenterInput input;
  input.small_toes = points.small_toes();
  for (std::size_t p = 0; p < kLegPoints; ++p) {
    if (p != kSmallToePoint && !points.has(p)) input.missing.emplace_back(kAugmenterPoints[p]);
  }
  if (!input.missing.empty()) return input;
  const std::size_t count = recording.instants().size();
  std::size_t legs = 0, all = 0;
  for (std::size_t t = 0; t < count; ++t) {
    if (!points.complete(t, kLegPoints)) continue;
    ++legs;
    if (points.complete(t, kAugmenterPoints.size())) ++all;
  }
  input.arms = 2 * all >= legs;  // where they are mostly absent they would cost most of the legs
  const std::size_t used = input.arms ? kAugmenterPoints.size() : kLegPoints;
  for (std::size_t t = 0; t < count; ++t) {
    if (!points.complete(t, used)) continue;
    std::size_t end = t;
    while (end + 1 < count && points.complete(end + 1, used)) ++end;
    AugmenterRun run = run_of(recording, points, used, t, end, input.covariances);
    if (run.steps.size() >= min_steps) {
      input.instants += end + 1 - t;
      input.runs.push_back(std::move(run));
    }
    t = end;
  }
  return input;
}

std::vector<std::string> people_to_augment(const std::vector<TrackName>& tracks) {
  std::map<std::string, std::set<std::string>> points;
  for (const TrackName& track : tracks) {
    const std::string prefix = prefix_of(track.label);
    points[prefix].insert(common_keypoint_name(track.label.substr(prefix.size())));
  }
  std::vector<std::string> people;
  for (const auto& [person, has] : points) {
    bool legs = true;
    for (std::size_t i = 0; i < kSides * kLegPoints; ++i) {
      if (i / kSides == kSmallToePoint) continue;
      legs = legs && has.contains(kSideNames[i % kSides] + std::string(kAugmenterPoints[i / kSides]));
    }
    if (legs) people.push_back(person);
  }
  return people;
}

}  // namespace marey::pipeline::keypoints

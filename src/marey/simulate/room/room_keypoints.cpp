#include "marey/simulate/room/room_keypoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "marey/core/keypoint_sets.h"
#include "marey/simulate/random.h"

namespace marey::simulate::room {
namespace {

constexpr double kSpell_s = 0.4;      // that an exchange of left and right lasts
constexpr double kMinObserved = 0.5;  // share of a person's points

struct BodyPoint {
  const char* name;
  Limb limb;
  Vector<3> in_limb;  // m; the limb's frame has x ahead, y to the left, z up
};

const std::vector<BodyPoint>& body_points() {
  static const std::vector<BodyPoint> kPoints{{"nose", head, {0.10, 0, 0.08}},
                                              {"left_eye", head, {0.085, 0.03, 0.11}},
                                              {"right_eye", head, {0.085, -0.03, 0.11}},
                                              {"left_ear", head, {0, 0.075, 0.09}},
                                              {"right_ear", head, {0, -0.075, 0.09}},
                                              {"left_shoulder", arm_l, {0, 0, 0}},
                                              {"right_shoulder", arm_r, {0, 0, 0}},
                                              {"left_elbow", forearm_l, {0, 0, 0}},
                                              {"right_elbow", forearm_r, {0, 0, 0}},
                                              {"left_wrist", hand_l, {0, 0, 0}},
                                              {"right_wrist", hand_r, {0, 0, 0}},
                                              {"left_hip", thigh_l, {0, 0, 0}},
                                              {"right_hip", thigh_r, {0, 0, 0}},
                                              {"left_knee", shank_l, {0, 0, 0}},
                                              {"right_knee", shank_r, {0, 0, 0}},
                                              {"left_ankle", foot_l, {0, 0, 0}},
                                              {"right_ankle", foot_r, {0, 0, 0}},
                                              {"upper_neck", chest, {0.01, 0, 0.50}},
                                              {"head_top", head, {0, 0, 0.22}},
                                              {"left_big_toe", foot_l, {0.20, -0.02, -0.05}},
                                              {"left_small_toe", foot_l, {0.16, 0.05, -0.05}},
                                              {"left_heel", foot_l, {-0.06, 0, -0.05}},
                                              {"right_big_toe", foot_r, {0.20, 0.02, -0.05}},
                                              {"right_small_toe", foot_r, {0.16, -0.05, -0.05}},
                                              {"right_heel", foot_r, {-0.06, 0, -0.05}}};
  return kPoints;
}

/// One seed from several numbers.
std::uint64_t keypoint_seed(std::initializer_list<std::uint64_t> numbers) {
  std::uint64_t x = 0x632BE59BD9B4E019u;
  for (const std::uint64_t number : numbers) {
    x = (x ^ (number + 0x9E3779B97F4A7C15u)) * 0xBF58476D1CE4E5B9u;
    x ^= x >> 31;
  }
  return x;
}

/// Whether a limb's sides are exchanged: time is cut into spells, each of which is drawn.
bool is_swapped(const RoomScene& scene, int camera, int actor, bool leg, double time_s, double fraction) {
  if (fraction <= 0) return false;
  const auto spell = static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(time_s / kSpell_s)));
  Random random(
      keypoint_seed({scene.options().seed, 7, static_cast<std::uint64_t>(camera), static_cast<std::uint64_t>(actor), leg, spell}));
  return random.chance(fraction);
}

bool is_of(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](const char* part) { return name.ends_with(part); });
}

/// The image of a point beside the joint: as far across the view as the bias says, always to the same side.
std::optional<Vector<2>> biased_pixel(const Camera& camera, const Vector<3>& location, double bias_m, Random fixed) {
  const auto at = camera.project_with_jacobian(location);
  if (!at) return std::nullopt;
  const double round = fixed.uniform(0, 2 * std::numbers::pi);
  const double scale = std::sqrt(at->by_world.squaredNorm() / 2);  // px/m across the view
  return Vector<2>(at->pixel + bias_m * scale * Vector<2>(std::cos(round), std::sin(round)));
}

/// Where people's points are when a rolling shutter exposes the rows that show them: between the first row's time and the last
/// one's they move straight.
std::vector<std::vector<Vector<3>>> rolling_keypoints(const RoomScene& scene, const Camera& camera, double time_s,
                                                      double readout_s) {
  auto locations = true_keypoints(scene, time_s);
  if (readout_s == 0) return locations;
  const auto first = true_keypoints(scene, time_s - readout_s / 2), last = true_keypoints(scene, time_s + readout_s / 2);
  for (std::size_t actor = 0; actor < locations.size(); ++actor) {
    for (std::size_t i = 0; i < locations[actor].size(); ++i) {
      const auto pixel = camera.project(locations[actor][i]);
      if (!pixel) continue;
      const double share = std::clamp((pixel->y() + 0.5) / camera.size().height, 0.0, 1.0);
      locations[actor][i] = (1 - share) * first[actor][i] + share * last[actor][i];
    }
  }
  return locations;
}

}  // namespace

std::vector<Vector<3>> keypoint_positions(const BodyPose& pose) {
  std::vector<Vector<3>> locations;
  for (const BodyPoint& point : body_points()) locations.push_back(pose[static_cast<std::size_t>(point.limb)] * point.in_limb);
  return locations;
}

const KeypointSet& room_keypoint_set() {
  return keypoint_set_named("body_25b");
}

std::vector<std::vector<Vector<3>>> true_keypoints(const RoomScene& scene, double time_s) {
  std::vector<std::vector<Vector<3>>> all;
  for (int actor = 0; actor < scene.actors(); ++actor) {
    const std::vector<Rigid3> segments = scene.segments(time_s, actor);
    BodyPose pose;
    std::copy(segments.begin(), segments.end(), pose.begin());
    all.push_back(keypoint_positions(pose));
  }
  return all;
}

std::vector<Keypoints<2>> keypoints_observed(const RoomScene& scene, int camera, double time_s, std::uint64_t draw,
                                             const KeypointErrors& errors) {
  const Camera eye = *scene.rig_at(time_s).cameras[static_cast<std::size_t>(camera)].camera();
  const std::uint64_t seed = scene.options().seed, own = static_cast<std::uint64_t>(camera);
  const KeypointSet& set = room_keypoint_set();
  const auto locations = rolling_keypoints(scene, eye, time_s, errors.readout_s);
  Random random(keypoint_seed({seed, 5, own, draw}));
  std::vector<std::pair<double, Keypoints<2>>> found;
  for (std::size_t actor = 0; actor < locations.size(); ++actor) {
    Keypoints<2> person;
    person.points.resize(set.points.size());
    std::size_t in_image = 0;
    const bool legs = is_swapped(scene, camera, static_cast<int>(actor), true, time_s, errors.swapped);
    const bool arms = is_swapped(scene, camera, static_cast<int>(actor), false, time_s, errors.swapped);
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const std::string& name = set.points[i];
      const bool swap = (legs && is_of(name, {"knee", "ankle", "toe", "heel"})) || (arms && is_of(name, {"elbow", "wrist"}));
      const std::size_t of = swap ? static_cast<std::size_t>(set.mirrored[i]) : i;
      const auto pixel = biased_pixel(eye, locations[actor][of], errors.bias_m, Random(keypoint_seed({seed, 6, own, actor, of})));
      const bool missing = random.chance(errors.missing), outlier = random.chance(errors.outliers);
      const double sigma = outlier ? errors.outlier_px : errors.noise_px;
      const Vector<2> noise = random.gaussian_pair(sigma);
      const double confidence = outlier ? random.uniform(0.2, 0.9) : random.uniform(0.6, 1.0);
      if (!pixel || !eye.in_image(*pixel)) continue;
      ++in_image;
      if (missing) continue;
      person.points[i] = Keypoint<2>{.position = *pixel + noise,
                                     .covariance = std::max(0.25, errors.noise_px * errors.noise_px) * Matrix<2>::Identity(),
                                     .visibility = confidence};
    }
    const double location = random.uniform();
    if (static_cast<double>(in_image) >= kMinObserved * static_cast<double>(set.points.size()))
      found.emplace_back(location, std::move(person));
  }
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<Keypoints<2>> people;
  for (auto& [location, person] : found) people.push_back(std::move(person));
  return people;
}

double clock_drift(const RoomScene& scene, int camera, const KeypointErrors& errors) {
  if (camera == 0) return 0;
  return Random(keypoint_seed({scene.options().seed, 8, static_cast<std::uint64_t>(camera)})).uniform(-errors.drift, errors.drift);
}

KeypointSequence keypoints_of_camera(const RoomScene& scene, int camera, const KeypointErrors& errors) {
  KeypointSequence sequence;
  sequence.set = room_keypoint_set();
  sequence.size = scene.options().image;
  sequence.rate_hz = scene.options().rate_hz;
  const double offset = scene.rig().cameras[static_cast<std::size_t>(camera)].offset_s.value_or(0);
  const double period = (1 + clock_drift(scene, camera, errors)) / scene.options().rate_hz;
  for (std::int64_t frame = 0; frame < scene.options().frames; ++frame)
    sequence.frames.push_back(
        keypoints_observed(scene, camera, static_cast<double>(frame) * period + offset, static_cast<std::uint64_t>(frame), errors));
  return sequence;
}

}  // namespace marey::simulate::room

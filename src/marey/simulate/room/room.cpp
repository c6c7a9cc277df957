// The room as a function of time: every path is made of sines, so that any frame can be asked for without those before it, and
// all that is random in a frame (noise, what is missed, ghosts) is drawn from a generator of that frame and camera alone.
// One frame costs cameras × markers × 15 distances between line pieces where a body hides its markers.
#include "marey/simulate/room/room.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/simulate/random.h"
#include "marey/simulate/room/body.h"
#include "marey/simulate/room/room_actors.h"
#include "marey/simulate/room/room_rig.h"

namespace marey::simulate::room {
namespace {

constexpr double kPi = std::numbers::pi;

/// One seed from several numbers (the finaliser of SplitMix64).
std::uint64_t mixed(std::uint64_t a, std::uint64_t b, std::uint64_t c = 0) {
  std::uint64_t x = a * 0x9E3779B97F4A7C15u + b * 0xD1B54A32D192ED03u + c * 0x8CB92BA72F3D8DD7u + 0x632BE59BD9B4E019u;
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

}  // namespace

struct RoomScene::Parts {
  RoomOptions options;
  Rig rig, after_bump;
  std::vector<Camera> cameras, cameras_after;
  std::vector<std::string> labels;
  std::vector<RoomActor> actors;
  std::vector<Body> props;
  std::vector<RoomProp> flying;  // the same
  std::vector<Drift> cloud;
  Drift wand_position, wand_turn;

  bool is_bumped(double time_s) const { return options.bump && time_s >= options.bump->time_s; }
  const Camera& camera(int index, double time_s) const {
    return (is_bumped(time_s) ? cameras_after : cameras)[static_cast<std::size_t>(index)];
  }

  std::vector<BodyPose> poses(double t) const;
  void add_actors(Random& random, double first_angle, double step_phase);
  void add_props();
  std::vector<Vector<3>> points(double t) const;
  bool covered(int marker, double t) const;
  bool observes(int index, double t, const Vector<3>& point, std::span<const BodyPose> bodies, Vector<2>& pixel) const;
  std::vector<RoomBlob> blobs(int index, double t, std::uint64_t draw) const;
  void merge(std::vector<RoomBlob>& blobs, std::span<const double> far) const;
};

std::vector<BodyPose> RoomScene::Parts::poses(double t) const {
  std::vector<BodyPose> all;
  for (const RoomActor& actor : actors) all.push_back(actor.pose(options, t));
  return all;
}

std::vector<Vector<3>> RoomScene::Parts::points(double t) const {
  std::vector<Vector<3>> result;
  const Vector<3> half = options.volume / 2;
  if (!actors.empty()) {
    for (const RoomActor& actor : actors) {
      const BodyPose at = actor.pose(options, t);
      for (const BodyMarker& marker : actor.markers) result.push_back(on_skin(at, marker, options.skin_m));
    }
  } else if (options.motion == RoomMotion::ground) {
    result = options.ground_frame;
  } else if (options.motion == RoomMotion::cloud) {
    for (const Drift& each : cloud) result.push_back(Vector<3>(0, 0, half.z()) + 0.98 * half.cwiseProduct(each.at(t)));
  } else {
    const Vector<3> turn = wand_turn.at(t);
    const double up = 1.4 * turn.x(), round = 2 * kPi * turn.y() + 0.4 * t;
    const Vector<3> axis(std::cos(up) * std::cos(round), std::cos(up) * std::sin(round), std::sin(up));
    const double middle = (options.wand.front() + options.wand.back()) / 2;
    const Vector<3> location = Vector<3>(0, 0, half.z()) + 0.92 * half.cwiseProduct(wand_position.at(t));
    for (const double along : options.wand) result.push_back(location + (along - middle) * axis);
  }
  for (const RoomProp& prop : flying) {
    const Rigid3 at = prop.pose(options, t);
    for (const auto& marker : prop.body.markers) result.push_back(at * marker.position);
  }
  return result;
}

/// Time is cut into slots, each of which may hold one gap of a marker, drawn from the slot's own number.
bool RoomScene::Parts::covered(int marker, double t) const {
  if (options.gap_fraction <= 0) return false;
  const double longest = options.gap_s, mean = 0.55 * longest,
               slot = std::max(0.4 * longest / options.gap_fraction, 1.05 * longest);
  const double which = std::floor(t / slot);
  const auto drawn = [&](std::uint64_t what) {
    const auto number = static_cast<std::uint64_t>(static_cast<std::int64_t>(which));
    return static_cast<double>(mixed(options.seed * 4 + what, number, static_cast<std::uint64_t>(marker)) >> 11) * 0x1.0p-53;
  };
  if (drawn(1) >= options.gap_fraction * slot / mean) return false;
  const double length = longest * (0.1 + 0.9 * drawn(2)), begin = drawn(3) * (slot - length);
  const double within = t - which * slot;
  return within >= begin && within < begin + length;
}

bool RoomScene::Parts::observes(int index, double t, const Vector<3>& point, std::span<const BodyPose> bodies,
                                Vector<2>& pixel) const {
  const Camera& eye = camera(index, t);
  const auto detected = eye.project(point);
  if (!detected || !eye.in_image(*detected)) return false;
  pixel = *detected;
  return !options.occlusion ||
         std::none_of(bodies.begin(), bodies.end(), [&](const BodyPose& at) { return hidden_by_body(at, point, eye.centre()); });
}

/// Blobs nearer than merge_px become one, again and again: each takes in the next that touches it.
void RoomScene::Parts::merge(std::vector<RoomBlob>& blobs, std::span<const double> far) const {
  std::vector<RoomBlob> result;
  std::vector<bool> used(blobs.size(), false);
  for (std::size_t i = 0; i < blobs.size(); ++i) {
    if (used[i]) continue;
    RoomBlob joint = blobs[i];
    std::size_t nearest = i;
    int count = 1;
    for (std::size_t j = i + 1; j < blobs.size(); ++j) {
      if (used[j] || (blobs[j].pixel - joint.pixel).norm() >= options.merge_px) continue;
      used[j] = true;
      joint.pixel = (joint.pixel * count + blobs[j].pixel) / (count + 1);
      ++count;
      joint.merged = true;
      if (far[j] < far[nearest]) nearest = j;
    }
    joint.marker = blobs[nearest].marker;
    result.push_back(joint);
  }
  blobs = std::move(result);
}

std::vector<RoomBlob> RoomScene::Parts::blobs(int index, double t, std::uint64_t draw) const {
  const std::vector<Vector<3>> locations = points(t);
  const std::vector<BodyPose> at = poses(t);
  Random random(mixed(options.seed, draw, static_cast<std::uint64_t>(index)));
  std::vector<RoomBlob> result;
  std::vector<double> far;
  for (int marker = 0; marker < std::ssize(locations); ++marker) {
    const Vector<3>& location = locations[static_cast<std::size_t>(marker)];
    Vector<2> pixel;
    if (!observes(index, t, location, at, pixel) || covered(marker, t)) continue;
    result.push_back({pixel, marker, false});
    far.push_back((location - camera(index, t).centre()).norm());
  }
  const std::size_t there = result.size();
  if (options.merge_px > 0) merge(result, far);
  std::erase_if(result, [&](const RoomBlob&) { return random.chance(options.dropped); });
  for (RoomBlob& blob : result) blob.pixel += random.gaussian_pair(options.noise_px);
  for (std::size_t i = 0; i < there; ++i) {
    if (!random.chance(options.ghosts)) continue;
    result.push_back(
        {{random.uniform(0, options.image.width - 1), random.uniform(0, options.image.height - 1)}, std::nullopt, false});
  }
  std::stable_sort(result.begin(), result.end(), [](const RoomBlob& a, const RoomBlob& b) { return a.pixel.y() < b.pixel.y(); });
  return result;
}

std::span<const NamedRoomMotion> room_motions() {
  static constexpr std::array<NamedRoomMotion, 9> kMotions{{{"walk", RoomMotion::walk},
                                                            {"run", RoomMotion::run},
                                                            {"wave", RoomMotion::wave},
                                                            {"kneel", RoomMotion::kneel},
                                                            {"roll", RoomMotion::roll},
                                                            {"still", RoomMotion::still},
                                                            {"wand", RoomMotion::wand},
                                                            {"ground", RoomMotion::ground},
                                                            {"cloud", RoomMotion::cloud}}};
  return kMotions;
}

RoomScene::RoomScene(const RoomOptions& options) : parts_(std::make_unique<Parts>()) {
  assert(options.cameras > 0 && options.markers > 0 && options.rate_hz > 0 && "a room needs a camera, a marker and a rate");
  assert((!options.bump || options.bump->camera < options.cameras) && "who is bumped must be there");
  assert(!options.wand.empty() && "a wand has a marker");
  Parts& parts = *parts_;
  parts.options = options;
  parts.rig = room_rig(options);
  parts.after_bump = bumped(parts.rig, options);
  for (const RigCamera& camera : parts.rig.cameras) parts.cameras.push_back(*camera.camera());
  for (const RigCamera& camera : parts.after_bump.cameras) parts.cameras_after.push_back(*camera.camera());

  Random random(mixed(options.seed, 1));
  const double first_angle = random.uniform(0, 2 * kPi), step_phase = random.uniform(0, 2 * kPi);
  parts.wand_position = Drift::drawn(1.3, random);
  parts.wand_turn = Drift::drawn(1.1, random);
  switch (options.motion) {
    case RoomMotion::walk:
    case RoomMotion::run:
    case RoomMotion::wave:
    case RoomMotion::kneel:
    case RoomMotion::roll:
    case RoomMotion::still:
      parts.add_actors(random, first_angle, step_phase);
      break;
    case RoomMotion::wand:
      for (std::size_t i = 0; i < options.wand.size(); ++i) parts.labels.push_back(fmt::format("wand{}", i + 1));
      break;
    case RoomMotion::ground:
      for (std::size_t i = 0; i < options.ground_frame.size(); ++i) parts.labels.push_back(fmt::format("frame{}", i + 1));
      break;
    case RoomMotion::cloud:
      for (int i = 0; i < options.markers; ++i) {
        parts.labels.push_back(fmt::format("M{}", i + 1));
        parts.cloud.push_back(Drift::drawn(0.7, random));
      }
      break;
  }
  parts.add_props();
}

void RoomScene::Parts::add_actors(Random& random, double first_angle, double step_phase) {
  for (int i = 0; i < options.actors; ++i) {
    RoomActor& actor = actors.emplace_back(RoomActor{.number = i,
                                                     .of = options.actors,
                                                     .name = i == 0 ? "" : fmt::format("actor{}:", i + 1),
                                                     .markers = position_markers(options.markers, random),
                                                     .first_angle = first_angle,
                                                     .step_phase = step_phase + 2.4 * i});
    for (BodyMarker& marker : actor.markers) labels.push_back(marker.label.insert(0, actor.name));
  }
}

/// By a generator of their own: the people are the same with them and without.
void RoomScene::Parts::add_props() {
  Random random(mixed(options.seed, 2));
  for (int i = 0; i < options.props; ++i) {
    const RoomProp& prop = flying.emplace_back(drawn_prop(i + 1, random));
    props.push_back(prop.body);
    for (const auto& marker : prop.body.markers) labels.push_back(marker.label);
  }
}

RoomScene::~RoomScene() = default;
RoomScene::RoomScene(RoomScene&&) noexcept = default;
RoomScene& RoomScene::operator=(RoomScene&&) noexcept = default;

const RoomOptions& RoomScene::options() const {
  return parts_->options;
}
const Rig& RoomScene::rig() const {
  return parts_->rig;
}
const Rig& RoomScene::rig_at(double time_s) const {
  return parts_->is_bumped(time_s) ? parts_->after_bump : parts_->rig;
}
const std::vector<std::string>& RoomScene::labels() const {
  return parts_->labels;
}
int RoomScene::actors() const {
  return static_cast<int>(parts_->actors.size());
}
std::optional<Skeleton> RoomScene::skeleton(int actor) const {
  if (actor >= actors()) return std::nullopt;
  Skeleton body = body_skeleton(parts_->actors[static_cast<std::size_t>(actor)].markers);
  if (actor > 0) body.name = fmt::format("body{}", actor + 1);
  return body;
}
std::vector<Rigid3> RoomScene::segments(double time_s, int actor) const {
  if (actor >= actors()) return {};
  const BodyPose at = parts_->actors[static_cast<std::size_t>(actor)].pose(parts_->options, time_s);
  return {at.begin(), at.end()};
}
std::vector<double> RoomScene::coordinates(double time_s, int actor) const {
  if (actor >= actors()) return {};
  return body_coordinates(parts_->actors[static_cast<std::size_t>(actor)].pose(parts_->options, time_s));
}
const std::vector<Body>& RoomScene::props() const {
  return parts_->props;
}
std::vector<Rigid3> RoomScene::prop_poses(double time_s) const {
  std::vector<Rigid3> poses;
  for (const RoomProp& prop : parts_->flying) poses.push_back(prop.pose(parts_->options, time_s));
  return poses;
}
std::vector<Vector<3>> RoomScene::points(double time_s) const {
  return parts_->points(time_s);
}

std::vector<bool> RoomScene::visible(int camera, double time_s, std::span<const Vector<3>> points) const {
  const std::vector<BodyPose> at = parts_->poses(time_s);
  std::vector<bool> result;
  for (int marker = 0; marker < std::ssize(points); ++marker) {
    Vector<2> pixel;
    result.push_back(parts_->observes(camera, time_s, points[static_cast<std::size_t>(marker)], at, pixel) &&
                     !parts_->covered(marker, time_s));
  }
  return result;
}

RoomFrame RoomScene::frame(std::int64_t index) const {
  RoomFrame frame;
  frame.index = index;
  frame.time_s = static_cast<double>(index) / parts_->options.rate_hz;
  frame.points = parts_->points(frame.time_s);
  for (int camera = 0; camera < parts_->options.cameras; ++camera) {
    const double offset = parts_->rig.cameras[static_cast<std::size_t>(camera)].offset_s.value_or(0);
    frame.detected.push_back(observed_by(camera, frame.time_s + offset, static_cast<std::uint64_t>(index)));
  }
  return frame;
}

std::vector<RoomBlob> RoomScene::observed_by(int camera, double time_s, std::uint64_t draw) const {
  return parts_->blobs(camera, time_s, draw);
}

}  // namespace marey::simulate::room

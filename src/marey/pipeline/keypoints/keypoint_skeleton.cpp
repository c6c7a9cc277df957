#include "marey/pipeline/keypoints/keypoint_skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/keypoints/blazepose_hips.h"
#include "marey/solve/skeleton/human.h"

namespace marey::pipeline::keypoints {
namespace {

using solve::skeleton::StandingMarker;
using solve::skeleton::StandingSegment;

constexpr double kSpineFraction = 0.15;  // of the distance from hips to shoulders where the trunk bends
constexpr double kMinPositions = 5;      // instants at which something must be seen
constexpr double kMinSine = 0.05;        // of the angle between directions that make a frame
constexpr double kShinToFloor_m = 0.06;
constexpr double kHeadAboveNeck = 0.3;  // of the distance from the shoulders' middle to the ears' where the head turns

constexpr std::array<const char*, 6> kNeeded{"left_hip", "right_hip", "left_knee", "right_knee", "left_shoulder", "right_shoulder"};

std::string other_side(const std::string& name) {
  if (name.starts_with("left_")) return "right_" + name.substr(5);
  if (name.starts_with("right_")) return "left_" + name.substr(6);
  return name;
}

/// A person's points over the recording.
class KeypointTracks {
 public:
  KeypointTracks(const Recording& recording, const std::string& person) : count_(recording.instants().size()) {
    for (const TrackColumns& track : recording.tracks()) {
      if (track.name.label.starts_with(person)) tracks_[track.name.label.substr(person.size())] = &track;
    }
  }

  std::size_t count() const { return count_; }
  bool has(const std::string& point) const { return tracks_.contains(point); }
  std::optional<Vector<3>> at(const std::string& point, std::size_t instant) const {
    const auto found = tracks_.find(point);
    if (found == tracks_.end()) return std::nullopt;
    const auto row = found->second->row_at(static_cast<std::int32_t>(instant));
    if (!row) return std::nullopt;
    return found->second->position(*row);
  }
  std::optional<Vector<3>> between(const std::string& a, const std::string& b, std::size_t instant) const {
    const auto one = at(a, instant), other = at(b, instant);
    if (!one || !other) return std::nullopt;
    return Vector<3>(0.5 * (*one + *other));
  }
  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& [name, track] : tracks_) names.push_back(name);
    return names;
  }

 private:
  std::map<std::string, const TrackColumns*> tracks_;
  std::size_t count_;
};

/// Median distance of two points, of both sides together; nothing if they are barely ever seen together.
std::optional<double> length_of(const KeypointTracks& tracks, const std::string& a, const std::string& b) {
  std::vector<double> lengths;
  const auto add = [&](const std::string& from, const std::string& to) {
    for (std::size_t t = 0; t < tracks.count(); ++t) {
      const auto one = tracks.at(from, t), other = tracks.at(to, t);
      if (one && other) lengths.push_back((*one - *other).norm());
    }
  };
  add(a, b);
  if (other_side(a) != b && other_side(a) != a) add(other_side(a), other_side(b));
  if (static_cast<double>(lengths.size()) < kMinPositions) return std::nullopt;
  return geometry::median(lengths);
}

using FrameAt = std::function<std::optional<Rigid3>(std::size_t instant)>;

/// The median of a point's coordinates in a frame that moves with a segment; of both sides, `mirrored` giving the other side's
/// frame, with y turned round.
std::optional<Vector<3>> position_in(const KeypointTracks& tracks, const std::string& point, const FrameAt& frame,
                                     const FrameAt& mirrored = {}) {
  std::array<std::vector<double>, 3> locations;
  const auto add = [&](const std::string& name, const FrameAt& frame_at, double side) {
    for (std::size_t t = 0; t < tracks.count(); ++t) {
      const auto at = tracks.at(name, t);
      const auto in = frame_at(t);
      if (!at || !in) continue;
      const Vector<3> local = in->inverse() * *at;
      locations[0].push_back(local.x());
      locations[1].push_back(side * local.y());
      locations[2].push_back(local.z());
    }
  };
  add(point, frame, 1);
  if (mirrored && other_side(point) != point) add(other_side(point), mirrored, -1);
  if (static_cast<double>(locations[0].size()) < kMinPositions) return std::nullopt;
  return Vector<3>(geometry::median(locations[0]), geometry::median(locations[1]), geometry::median(locations[2]));
}

/// x ahead, y to the left, z up, from a direction that is exact and one that is about so.
std::optional<Matrix<3>> axes_of(const Vector<3>& z, const Vector<3>& about_y) {
  const Vector<3> x = about_y.normalized().cross(z.normalized());
  if (!(x.norm() > kMinSine)) return std::nullopt;
  Matrix<3> axes;
  axes.col(0) = x.normalized();
  axes.col(2) = z.normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

/// Origin midway between the hips, up towards the shoulders' middle.
std::optional<Rigid3> trunk_at(const KeypointTracks& tracks, std::size_t t) {
  const auto hips = tracks.between("left_hip", "right_hip", t), shoulders = tracks.between("left_shoulder", "right_shoulder", t);
  if (!hips || !shoulders) return std::nullopt;
  const auto axes = axes_of(*shoulders - *hips, *tracks.at("left_shoulder", t) - *tracks.at("right_shoulder", t));
  if (!axes) return std::nullopt;
  return Rigid3{*axes, *hips};
}

/// Origin midway between the ears, ahead towards the nose.
std::optional<Rigid3> head_at(const KeypointTracks& tracks, std::size_t t) {
  const auto ears = tracks.between("left_ear", "right_ear", t), nose = tracks.at("nose", t);
  if (!ears || !nose) return std::nullopt;
  const Vector<3> left = *tracks.at("left_ear", t) - *tracks.at("right_ear", t), up = (*nose - *ears).cross(left);
  const auto axes = axes_of(up, left);
  if (!axes) return std::nullopt;
  return Rigid3{*axes, *ears};
}

/// Origin in the ankle, ahead from the heel to the big toe, the ankle above them.
std::optional<Rigid3> foot_at(const KeypointTracks& tracks, const std::string& side, std::size_t t) {
  const auto ankle = tracks.at(side + "ankle", t), heel = tracks.at(side + "heel", t), toe = tracks.at(side + "big_toe", t);
  if (!ankle || !heel || !toe) return std::nullopt;
  const Vector<3> ahead = *toe - *heel;
  const Vector<3> left = (*ankle - *heel).cross(ahead);
  const auto axes = axes_of(ahead.cross(left), left);
  if (!axes) return std::nullopt;
  return Rigid3{*axes, *ankle};
}

/// Takes a coordinate out: its joint does not rotate about that axis.
void take_out_coordinate(Skeleton& skeleton, const std::string& name) {
  const auto index = skeleton.coordinate(name);
  if (!index) return;
  skeleton.coordinates.erase(skeleton.coordinates.begin() + *index);
  for (Segment& segment : skeleton.segments) {
    std::erase_if(segment.joint.axes, [&](const JointAxis& axis) { return axis.coordinate == index; });
    for (JointAxis& axis : segment.joint.axes) {
      if (axis.coordinate && *axis.coordinate > *index) --*axis.coordinate;
    }
  }
}

/// The standing person: segments upright in their own frames, points where the recording has them.
class StandingPerson {
 public:
  StandingPerson(const KeypointTracks& tracks, std::string person) : tracks_(tracks), person_(std::move(person)) {}

  Skeleton build() {
    const bool blaze = tracks_.has("left_eye_inner");
    const double hip_in = blaze ? kBlazeHipInwards_m : 0, hip_down = blaze ? kBlazeHipDown_m : 0;
    const double hips = needed("left_hip", "right_hip") / 2 + hip_in;
    const double thigh = needed("left_hip", "left_knee") + hip_down;
    const auto shank = length_of(tracks_, "left_knee", "left_ankle");
    const Vector<3> shoulder = shoulder_in_trunk() - Vector<3>(0, 0, hip_down);
    const double height = thigh + shank.value_or(thigh) + kShinToFloor_m;
    const Vector<3> middle(0, 0, height);
    add("pelvis", middle);
    add("trunk", middle + Vector<3>(0, 0, kSpineFraction * shoulder.z()), Vector<3>(middle + Vector<3>(0, 0, shoulder.z())));
    mark("mid_hip", "pelvis", middle - Vector<3>(0, 0, hip_down));
    for (const std::string side : {"left_", "right_"}) {
      const double left = side == "left_" ? 1 : -1;
      const Vector<3> hip = middle + Vector<3>(0, left * hips, 0), knee = hip - Vector<3>(0, 0, thigh);
      mark(side + "hip", "pelvis", hip - Vector<3>(0, left * hip_in, hip_down));
      add(side + "thigh", hip, knee);
      add_leg(side, knee, shank);
      add_arm(side, middle + Vector<3>(shoulder.x(), left * shoulder.y(), shoulder.z()));
    }
    add_neck(middle, hip_down);
    const std::string name = person_.empty() ? "person" : person_.substr(0, person_.size() - 1);
    Skeleton skeleton = solve::skeleton::human_skeleton(name, segments_, markers_);
    // Two hips do not show how the pelvis is tilted: it goes with the trunk. A wrist does not show how a forearm turns.
    for (const char* unobserved : {"spine_flexion", "left_elbow_pronation", "right_elbow_pronation"})
      take_out_coordinate(skeleton, unobserved);
    return skeleton;
  }

 private:
  double needed(const std::string& a, const std::string& b) const {
    const auto length = length_of(tracks_, a, b);
    if (!length) throw Error("{}{} and {}{} are barely ever seen at the same time; a skeleton needs both", person_, a, person_, b);
    return *length;
  }

  Vector<3> shoulder_in_trunk() const {
    const FrameAt trunk = [this](std::size_t t) { return trunk_at(tracks_, t); };
    const auto location = position_in(tracks_, "left_shoulder", trunk, trunk);
    if (!location) throw Error("{}hips and shoulders are barely ever seen at the same time; a skeleton needs both", person_);
    return *location;
  }

  void add(const std::string& segment, const Vector<3>& origin, std::optional<Vector<3>> end = {}) {
    segments_.push_back({segment, Rigid3{Matrix<3>::Identity(), origin}, end});
  }

  void mark(const std::string& point, const std::string& segment, const Vector<3>& location) {
    if (tracks_.has(point)) markers_.push_back({person_ + point, segment, location});
  }

  void add_leg(const std::string& side, const Vector<3>& knee, const std::optional<double>& shank) {
    mark(side + "knee", side + "thigh", knee);
    if (!shank) return;
    const Vector<3> ankle = knee - Vector<3>(0, 0, *shank);
    add(side + "shank", knee, ankle);
    mark(side + "ankle", side + "shank", ankle);
    const FrameAt own = [&](std::size_t t) { return foot_at(tracks_, side, t); };
    const FrameAt other = [&](std::size_t t) { return foot_at(tracks_, other_side(side), t); };
    const auto toe = position_in(tracks_, side + "big_toe", own, other);
    if (!toe) return;
    add(side + "foot", ankle, ankle + *toe);
    for (const char* point : {"heel", "big_toe", "small_toe"}) {
      if (const auto location = position_in(tracks_, side + point, own, other))
        mark(side + point, side + "foot", ankle + *location);
    }
  }

  void add_arm(const std::string& side, const Vector<3>& shoulder) {
    mark(side + "shoulder", "trunk", shoulder);
    const auto upper = length_of(tracks_, "left_shoulder", "left_elbow");
    if (!upper) return;
    const Vector<3> elbow = shoulder - Vector<3>(0, 0, *upper);
    add(side + "upper_arm", shoulder, elbow);
    mark(side + "elbow", side + "upper_arm", elbow);
    const auto fore = length_of(tracks_, "left_elbow", "left_wrist");
    if (!fore) return;
    const Vector<3> wrist = elbow - Vector<3>(0, 0, *fore);
    add(side + "forearm", elbow, wrist);
    mark(side + "wrist", side + "forearm", wrist);
  }

  void add_neck(const Vector<3>& middle, double hip_down) {
    const FrameAt trunk = [this](std::size_t t) { return trunk_at(tracks_, t); };
    const Vector<3> hips = middle - Vector<3>(0, 0, hip_down);
    for (const char* point : {"neck", "upper_neck"}) {
      if (const auto location = position_in(tracks_, point, trunk)) mark(point, "trunk", hips + *location);
    }
    // Where the ears' middle is, in the trunk's frame: the head stands there, and turns below it.
    std::array<std::vector<double>, 2> ears;
    for (std::size_t t = 0; t < tracks_.count(); ++t) {
      const auto frame = trunk_at(tracks_, t);
      const auto at = tracks_.between("left_ear", "right_ear", t);
      if (!frame || !at || !tracks_.at("nose", t)) continue;
      const Vector<3> local = frame->inverse() * *at;
      ears[0].push_back(local.x());
      ears[1].push_back(local.z());
    }
    if (static_cast<double>(ears[0].size()) < kMinPositions) return;
    const Vector<3> between_ears = hips + Vector<3>(geometry::median(ears[0]), 0, geometry::median(ears[1]));
    const Vector<3> shoulders = *segments_[1].end;
    add("head", shoulders + kHeadAboveNeck * (between_ears - shoulders));
    const FrameAt head = [this](std::size_t t) { return head_at(tracks_, t); };
    Vector<3> top = between_ears + Vector<3>(0, 0, 0.12);
    for (const char* point : {"nose", "left_eye", "right_eye", "left_ear", "right_ear", "head_top", "left_mouth", "right_mouth"}) {
      const auto location = position_in(tracks_, point, head, head);
      if (!location) continue;
      mark(point, "head", between_ears + *location);
      if (std::string_view(point) == "head_top") top = between_ears + *location;
    }
    segments_.back().end = top;
  }

  const KeypointTracks& tracks_;
  std::string person_;
  std::vector<StandingSegment> segments_;
  std::vector<StandingMarker> markers_;
};

}  // namespace

std::vector<std::string> people_with_keypoints(const std::vector<TrackName>& tracks) {
  std::map<std::string, std::set<std::string>> points;
  for (const TrackName& track : tracks) {
    const std::size_t begin = track.label.find_last_of(':') + 1;
    points[track.label.substr(0, begin)].insert(track.label.substr(begin));
  }
  std::vector<std::string> people;
  for (const auto& [person, has] : points) {
    if (std::all_of(kNeeded.begin(), kNeeded.end(), [&](const char* point) { return has.contains(point); }))
      people.push_back(person);
  }
  return people;
}

Skeleton skeleton_of_keypoints(const Recording& recording, const std::string& person) {
  const KeypointTracks tracks(recording, person);
  return StandingPerson(tracks, person).build();
}

}  // namespace marey::pipeline::keypoints

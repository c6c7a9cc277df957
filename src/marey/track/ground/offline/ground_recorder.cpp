#include "marey/track/ground/offline/ground_recorder.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "marey/track/ground/offline/ground_cut.h"
#include "marey/track/ground/offline/ground_doubles.h"
#include "marey/track/ground/offline/ground_people.h"
#include "marey/track/ground/offline/ground_swaps.h"

namespace marey::track::ground::offline {
namespace {

static_assert(sizeof(GroundSample) <= 48, "25 people for 90 minutes at 25 frames a second are 3.4 million samples");

constexpr double kUnobservedPush =
    1.6;  // times the typical: an unseen target may have done anything; a wrong join costs an identity

constexpr double kNear = 4 / 1.5;  // m: one nearer than this, for each m/s^1.5 of how hastily people move, may have been taken over

std::int8_t rounded(double value) {
  return static_cast<std::int8_t>(std::lround(std::clamp(value, -127.0, 127.0)));
}

/// The observations of one target at one instant, as one.
class JointObservation {
 public:
  void add(const Observation<2>& detected, const Vector<2>& brought) {
    const Matrix<2> weight = detected.covariance->inverse();
    weights_ += weight;
    locations_ += weight * (detected.value + brought);
    cameras_ |= mask_of(detected.camera);
    score_ = std::max(score_, detected.score);
    shared_ = shared_ && detected.shared;
    if (!detected.appearance) return;
    const Appearance& appearance = *detected.appearance;
    const double certainty = 1 / (static_cast<double>(appearance.deviation) * appearance.deviation);
    certainty_ += certainty;
    colours_ += certainty * Vector<3>(appearance.lightness, appearance.a, appearance.b);
  }

  GroundSample sample(std::int32_t instant) const {
    const Matrix<2> covariance = weights_.inverse();
    const Vector<2> location = covariance * locations_;
    GroundSample sample;
    sample.instant = instant;
    sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
    sample.covariance = {static_cast<float>(covariance(0, 0)), static_cast<float>(covariance(0, 1)),
                         static_cast<float>(covariance(1, 1))};
    sample.score = static_cast<float>(score_);
    sample.cameras = cameras_;
    sample.shared = shared_;
    if (certainty_ == 0) return sample;
    for (int i = 0; i < 3; ++i) sample.colour[i] = rounded(colours_[i] / certainty_);
    sample.colour_deviation = static_cast<std::uint8_t>(std::clamp(std::lround(1 / std::sqrt(certainty_)), 1L, 254L));
    return sample;
  }

  bool empty() const { return cameras_ == 0; }

 private:
  Matrix<2> weights_ = Matrix<2>::Zero();
  Vector<2> locations_ = Vector<2>::Zero();
  CameraMask cameras_ = 0;
  double score_ = 0;
  bool shared_ = true;
  double certainty_ = 0;
  Vector<3> colours_ = Vector<3>::Zero();
};

JointObservation join_observations(const Track<2>& track, Timestamp now, std::span<const CameraObservations> views,
                                   std::span<const ObservationMatch> matches) {
  JointObservation joint;
  for (const ObservationMatch& match : matches) {
    if (match.track != track.id) continue;
    const CameraObservations& view = views[match.view];
    joint.add(view.detected[match.observation], seconds(now - view.time) * track.velocity);
  }
  return joint;
}

}  // namespace

void GroundRecorder::add(std::int32_t frame, Timestamp time, std::span<const Track<2>> tracks,
                         std::span<const CameraObservations> views, std::span<const ObservationMatch> matches) {
  assert((frames_.empty() || frame > frames_.back()) && "frames are added in order, each once");
  const auto instant = static_cast<std::int32_t>(frames_.size());
  frames_.push_back(frame);
  times_.push_back(time);
  for (const CameraObservations& view : views) {
    const auto camera = static_cast<std::size_t>(number(view.camera));
    if (camera >= camera_begins_.size()) camera_begins_.resize(camera + 1, std::numeric_limits<std::int32_t>::max());
    camera_begins_[camera] = std::min(camera_begins_[camera], instant);
  }
  std::vector<GroundTracklet> still_open;
  still_open.reserve(tracks.size());
  auto open = open_.begin();  // both lists are in the order of ids
  const auto close = [&] {
    open->samples.shrink_to_fit();
    if (open->confirmed && !open->samples.empty()) closed_.push_back(std::move(*open));
    ++open;
  };
  for (const Track<2>& track : tracks) {
    while (open != open_.end() && open->runs.front().track < track.id) close();
    const bool known = open != open_.end() && open->runs.front().track == track.id;
    still_open.push_back(known ? std::move(*open++) : GroundTracklet{.runs = {{track.id, 0}}, .confirmed = false, .samples = {}});
    GroundTracklet& tracklet = still_open.back();
    tracklet.confirmed |= track.confirmed;
    const JointObservation joint = join_observations(track, time, views, matches);
    if (!joint.empty()) tracklet.samples.push_back(joint.sample(instant));
  }
  while (open != open_.end()) close();
  open_ = std::move(still_open);
}

std::optional<TrackId> GroundRecorder::Joined::person_of(TrackId track, std::int32_t frame) const {
  const auto next =
      std::upper_bound(pieces.begin(), pieces.end(), std::pair(track, frame),
                       [](const auto& sought, const Piece& piece) { return sought < std::pair(piece.track, piece.first); });
  if (next == pieces.begin() || std::prev(next)->track != track || std::prev(next)->last < frame) return std::nullopt;
  return std::prev(next)->person;
}

std::vector<GroundTracklet> GroundRecorder::tracklets() && {
  for (GroundTracklet& open : open_) {
    if (open.confirmed && !open.samples.empty()) closed_.push_back(std::move(open));
  }
  open_.clear();
  std::sort(closed_.begin(), closed_.end(),
            [](const GroundTracklet& a, const GroundTracklet& b) { return a.runs.front().track < b.runs.front().track; });
  return std::move(closed_);
}

GroundRecorder::Joined GroundRecorder::join(const GroundJoinOptions& options, const InSight& in_sight) && {
  std::vector<GroundTracklet> whole = std::move(*this).tracklets();
  SwapRepairOptions swaps;
  swaps.max_speed = options.max_speed;
  swaps.motion = options.motion;
  swaps.teams = options.teams;
  repair_swaps(whole, times_, swaps);
  std::vector<GroundTracklet> tracklets = cut_at_appearance_changes(std::move(whole), times_);
  tracklets = cut_where_impossible(std::move(tracklets), times_);
  tracklets = merge_doubles(std::move(tracklets), times_);
  tracklets = end_before_successors(std::move(tracklets), times_);
  tracklets = cut_where_others_end(std::move(tracklets), times_, {.near = kNear * options.motion.acceleration});
  GroundMotion unobserved = options.motion;
  unobserved.acceleration *= kUnobservedPush;
  const std::vector<GroundChain> chains =
      chain(tracklets, times_, in_sight,
            {.longest_gap = options.longest_gap, .max_speed = options.max_speed, .motion = unobserved, .teams = options.teams});
  return people_from_chains(std::move(tracklets), chains, {frames_, times_, camera_begins_}, options);
}

}  // namespace marey::track::ground::offline

#include "marey/pipeline/people/ground/ground_stage.h"

#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/pipeline/people/no_people_found.h"

namespace marey::pipeline::people::ground {
namespace {

constexpr std::size_t kMaxCameras = 64;

std::vector<double> offsets_of(const Rig& rig) {
  std::vector<double> offsets;
  for (const RigCamera& camera : rig.cameras) offsets.push_back(camera.offset_s.value_or(0));
  return offsets;
}

}  // namespace

Rig ground_rig(const Rig& rig, const std::vector<corridor::Feed>& feeds) {
  if (feeds.empty()) throw Error("{}", "the rig has no camera");
  if (feeds.size() > kMaxCameras) throw Error("the rig has {} cameras; {} is the most", feeds.size(), kMaxCameras);
  return corridor::rig_as_fed(rig, feeds);
}

GroundStage::GroundStage(const std::vector<corridor::Feed>& feeds, const PeopleOnGroundOptions& options, GroundScene scene)
    : options_(options), scene_(std::move(scene)), paths_(offsets_of(scene_.rig)), boxes_(feeds.size()) {
  header_.name = "people on the ground";
  header_.frame.kind = FrameOfReference::Kind::user_ground;
  header_.time_base = {.kind = TimeBase::Kind::camera, .camera = CameraId{0}};
  header_.track_kind = TrackKind::person;
  header_.made_by.program = "marey track";
  header_.rate_hz = feeds.front().rate_hz();
  header_.rig = scene_.rig;
  header_.smoothed = !options.live;
}

void GroundStage::note(const track::ground::GroundInstant& instant, std::span<const track::ground::ObservationMatch> matches) {
  paths_.add(instant.cameras, matches);
  boxes_.add(instant, matches);
}

Instant GroundStage::live_instant(const FrameSet& frames, std::span<const Track<2>> tracks) const {
  Instant instant;
  instant.index = frames.index;
  instant.time = own_time(frames.time);
  for (const Track<2>& track : tracks) {
    if (!track.confirmed || !scene_.area.holds(track.position)) continue;
    Sample& sample = instant.samples.emplace_back();
    sample.track = track.id;
    sample.position.head<2>() = scene_.area.ground(track.position);
    sample.velocity.emplace(Vector<3>::Zero()).head<2>() = scene_.area.ground_velocity(track.velocity);
    sample.provenance = track.provenance;
    sample.cameras = track.cameras;
  }
  return instant;
}

void GroundStage::add_live_boxes(const FrameSet& frames, std::span<const track::ground::CameraObservations> observed,
                                 std::span<const track::ground::ObservationMatch> matches, Instant& instant) {
  if (!boxes_.enabled()) return;
  boxes_.clear();
  boxes_.add_frames(frames);
  boxes_.add(track::ground::GroundInstant(static_cast<std::int32_t>(frames.index), frames.time, observed), matches);
  boxes_.rename([](TrackId track, std::int32_t) { return track; });
  const Timestamp rig_time = instant.time + rig_time_offset(header_.time_base, scene_.rig);
  boxes_.add_to(instant, rig_time, scene_, std::nullopt);
}

void GroundStage::explain_empty_result(corridor::Summary& summary) {
  if (const auto why = why_none(summary)) summary.warnings.push_back(*why);
}

void GroundStage::report_times(corridor::Summary& summary) const {
  for (std::string& message_text : contradicted_offsets(scene_.rig, paths_)) summary.warnings.push_back(std::move(message_text));
  for (const corridor::Summary::Camera& camera : summary.cameras) {
    if (camera.frames > 0) continue;
    summary.warnings.push_back(fmt::format("camera \"{}\" has no frame within the time of camera \"{}\"; is its offset_s right?",
                                           camera.name, scene_.rig.cameras.front().name));
  }
}

}  // namespace marey::pipeline::people::ground

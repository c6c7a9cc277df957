#include "marey/pipeline/people/ground/ground_offsets.h"

#include <algorithm>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/pipeline/corridor/feed.h"
#include "marey/pipeline/people/ground/ground_camera.h"

namespace marey::pipeline::people::ground {
namespace {

constexpr double kLogged_s = 20;
constexpr double kWrongBy_s = 5;  // how wrong an offset that a person gave is likely to be

bool appearance_at_ground(const RigCamera& camera) {
  return (!camera.source.empty() || !camera.detections.empty()) && (camera.camera_from_world || camera.ground_from_image);
}

/// Follows people in one camera alone, by its own clock.
class SingleCamera {
 public:
  SingleCamera(const RigCamera& camera, const geometry::GroundSurface& ground, const reconstruct::GroundArea& area,
               const RigOffsetsOptions& options)
      : feed_(without_offset(camera), CameraId{}, {.rate_hz = options.rate_hz}),
        views_(ground_views({ground_view_of(feed_.camera(), ground)})),
        camera_(feed_, views_, area, {.detector = options.detector}),
        tracker_(track::ground::make_ground_tracker(options.tracker, views_)),
        seconds_(options.seconds) {}

  std::optional<std::int64_t> frames() const {
    const auto all = feed_.info().frame_count;
    if (!all) return std::nullopt;
    return std::min(*all, static_cast<std::int64_t>(seconds_ * feed_.rate_hz()));
  }

  /// Takes in one frame; false at the end.
  bool step() {
    const auto given = feed_.next();
    if (!given || seconds(given->frame.time) > seconds_) return false;
    const Timestamp now = given->frame.time;
    const auto detected = camera_.observe(*given, tracker_->expected(now));
    tracker_->step(now, {&detected, 1});
    log_.add({&detected, 1}, tracker_->matches());
    return true;
  }

  std::vector<marey::calibrate::pitch::GroundPath> paths() const { return log_.paths(0); }

 private:
  static RigCamera without_offset(RigCamera camera) {
    camera.offset_s.reset();
    return camera;
  }

  corridor::Feed feed_;
  std::shared_ptr<const GroundViews> views_;
  GroundCamera camera_;
  std::unique_ptr<track::ground::GroundTracker> tracker_;
  double seconds_;
  GroundPathLog log_{{0.0}};
};

/// The paths that each of these cameras sees, followed side by side. `hooks` are called on this thread.
std::vector<std::vector<marey::calibrate::pitch::GroundPath>> track_alone(const std::vector<const RigCamera*>& cameras,
                                                                          const geometry::GroundSurface& ground,
                                                                          const reconstruct::GroundArea& area,
                                                                          const RigOffsetsOptions& options, const Hooks& hooks) {
  std::vector<std::unique_ptr<SingleCamera>> runs(cameras.size());
  tbb::parallel_for(std::size_t{0}, cameras.size(),
                    [&](std::size_t i) { runs[i] = std::make_unique<SingleCamera>(*cameras[i], ground, area, options); });
  std::vector<char> goes_on(cameras.size(), 1);
  const auto total = runs.front()->frames();
  for (std::int64_t done = 1; std::find(goes_on.begin(), goes_on.end(), 1) != goes_on.end(); ++done) {
    tbb::parallel_for(std::size_t{0}, runs.size(), [&](std::size_t i) {
      if (goes_on[i]) goes_on[i] = runs[i]->step() ? 1 : 0;
    });
    hooks.advance({"comparing clocks", done, total});
  }
  std::vector<std::vector<marey::calibrate::pitch::GroundPath>> paths;
  for (const auto& run : runs) paths.push_back(run->paths());
  return paths;
}

std::string_view reason(marey::calibrate::pitch::OffsetVerdict verdict) {
  switch (verdict) {
    case marey::calibrate::pitch::OffsetVerdict::found:
      return "";
    case marey::calibrate::pitch::OffsetVerdict::no_overlap:
      return "no person was seen on ground that it has in common with another camera";
    case marey::calibrate::pitch::OffsetVerdict::no_motion:
      return "too few people move on the ground that it has in common with others";
    case marey::calibrate::pitch::OffsetVerdict::ambiguous:
      return "no offset explains how people move plainly better than others";
  }
  return "";
}

std::string after(double offset_s, double deviation_s, const std::string& first) {
  return fmt::format("was started {:.3f} s (± {:.3f}) {} \"{}\"", std::abs(offset_s), deviation_s,
                     offset_s < 0 ? "before" : "after", first);
}

}  // namespace

void GroundPathLog::add(std::span<const track::ground::CameraObservations> views,
                        std::span<const track::ground::ObservationMatch> matches) {
  for (const track::ground::ObservationMatch& match : matches) {
    const track::ground::CameraObservations& view = views[static_cast<std::size_t>(match.view)];
    const auto camera = static_cast<std::size_t>(number(view.camera));
    const double own = seconds(view.time) - offsets_[camera];
    if (own > kLogged_s) continue;
    const Observation<2>& detected = view.detected[static_cast<std::size_t>(match.observation)];
    if (detected.shared) continue;
    auto& samples = paths_[{camera, match.track}].samples;
    if (samples.empty() || own > samples.back().time_s) samples.push_back({own, detected.value, *detected.covariance});
  }
}

std::vector<marey::calibrate::pitch::GroundPath> GroundPathLog::paths(std::size_t camera) const {
  std::vector<marey::calibrate::pitch::GroundPath> result;
  for (const auto& [owner, path] : paths_) {
    if (owner.first == camera) result.push_back(path);
  }
  return result;
}

bool lacks_offsets(const Rig& rig) {
  const auto able = std::count_if(rig.cameras.begin(), rig.cameras.end(), appearance_at_ground);
  const auto first = std::find_if(rig.cameras.begin(), rig.cameras.end(), appearance_at_ground);
  return able >= 2 && std::any_of(first + 1, rig.cameras.end(),
                                  [](const RigCamera& camera) { return appearance_at_ground(camera) && !camera.offset_s; });
}

RigOffsets find_rig_offsets(const Rig& rig, const reconstruct::GroundArea& area, const RigOffsetsOptions& options,
                            const Hooks& hooks) {
  RigOffsets result;
  std::vector<const RigCamera*> cameras;
  std::vector<double> assumed;
  for (const RigCamera& camera : rig.cameras) {
    if (!appearance_at_ground(camera)) continue;
    cameras.push_back(&camera);
    assumed.push_back(camera.offset_s.value_or(0));
  }
  if (cameras.size() < 2) return result;
  const auto paths = track_alone(cameras, rig.ground, area, options, hooks);
  const auto found = marey::calibrate::pitch::find_ground_offsets(paths, assumed, options.search);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const RigCamera& camera = *cameras[i];
    // Offsets are found to the first camera, whose own clock may have one.
    const double against_first = assumed[i] - assumed[0];
    const bool moved = marey::calibrate::pitch::contradicts(found[i], against_first, options.search);
    const double offset = camera.offset_s || !moved ? assumed[i] : assumed[0] + found[i].offset_s;
    result.cameras.push_back({camera.name, found[i], offset});
    if (i == 0) continue;
    if (found[i].verdict == marey::calibrate::pitch::OffsetVerdict::found && !camera.offset_s) {
      result.notes.push_back(fmt::format(
          "camera \"{}\" {}, as people move{}", camera.name, after(found[i].offset_s, found[i].deviation_s, cameras[0]->name),
          moved ? "" : fmt::format("; that is as good as offset_s = {:g}, which is kept", assumed[i])));
    } else if (!camera.offset_s) {
      result.warnings.push_back(fmt::format(
          "camera \"{}\": when it was started is not known and cannot be reported: {}; 0 is taken. Give offset_s in the rig, what "
          "is to be added to its times",
          camera.name, reason(found[i].verdict)));
    } else if (moved) {
      result.warnings.push_back(fmt::format("camera \"{}\": its offset_s is given as {:g}, but as people move it {}", camera.name,
                                            *camera.offset_s, after(found[i].offset_s, found[i].deviation_s, cameras[0]->name)));
    }
  }
  return result;
}

void enter_offsets(Rig& rig, const RigOffsets& offsets) {
  for (const RigOffsets::Camera& one : offsets.cameras) {
    if (one.found.verdict != marey::calibrate::pitch::OffsetVerdict::found) continue;
    for (RigCamera& camera : rig.cameras) {
      if (camera.name == one.name && !camera.offset_s) camera.offset_s = one.offset_s;
    }
  }
}

std::vector<std::string> contradicted_offsets(const Rig& rig, const GroundPathLog& log) {
  std::vector<std::vector<marey::calibrate::pitch::GroundPath>> paths;
  std::vector<double> assumed;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    paths.push_back(log.paths(c));
    assumed.push_back(rig.cameras[c].offset_s.value_or(0));
  }
  if (assumed.empty()) return {};
  marey::calibrate::pitch::GroundOffsetOptions near;
  const auto [minimum, maximum] = std::minmax_element(assumed.begin(), assumed.end());
  near.max_offset_s = kWrongBy_s + (*maximum - *minimum);
  const auto found = marey::calibrate::pitch::find_ground_offsets(paths, assumed, near);
  std::vector<std::string> warnings;
  for (std::size_t c = 1; c < found.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    if (!camera.offset_s || !marey::calibrate::pitch::contradicts(found[c], assumed[c] - assumed[0])) continue;
    warnings.push_back(fmt::format("camera \"{}\": its offset_s is given as {:g}, but as people move it {}", camera.name,
                                   *camera.offset_s, after(found[c].offset_s, found[c].deviation_s, rig.cameras[0].name)));
  }
  return warnings;
}

}  // namespace marey::pipeline::people::ground

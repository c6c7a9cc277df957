#include "marey/pipeline/people/ground/track_ground.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/draw/overlay_video.h"
#include "marey/draw/pitch_view_video.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/take/take_file.h"
#include "marey/format/tracks/view_box_file.h"
#include "marey/pipeline/corridor/stabilised_camera.h"
#include "marey/pipeline/people/ground/ground_again.h"
#include "marey/pipeline/people/ground/ground_offsets.h"
#include "marey/pipeline/people/number_sink.h"

namespace marey::pipeline::people::ground {
namespace {

namespace fs = std::filesystem;

void check(const Rig& rig, const GroundOutput& output, const PeopleOnGroundOptions& options) {
  if (options.rate_hz && !(*options.rate_hz > 0))
    throw Error("the rate is {} frames a second; it must be positive", *options.rate_hz);
  if (!(options.margin >= 0)) throw Error("the margin is {} m; it must not be negative", options.margin);
  const auto has_images = [](const RigCamera& camera) { return !camera.source.empty(); };
  const std::string& videos = output.overlays.empty() ? output.copies : output.overlays;
  if (!videos.empty() && std::none_of(rig.cameras.begin(), rig.cameras.end(), has_images))
    throw Error("{}: no camera has images to draw into; ask for a pitch view instead", videos);
  if (!output.numbers.empty() && std::none_of(rig.cameras.begin(), rig.cameras.end(), has_images))
    throw Error("{}: numbers are read in images, and no camera has any", output.numbers);
}

CameraId id_of(const Rig& rig, const std::string& name) {
  Rig copy = rig;
  return CameraId{static_cast<int>(&camera_named(copy, name) - copy.cameras.data())};
}

std::string video_of(const std::string& folder, const RigCamera& camera) {
  return (fs::path(folder) / (camera.name + ".mp4")).string();
}

std::vector<std::unique_ptr<Sink>> videos_in(const std::string& folder, const draw::OverlayOptions& drawn,
                                             const std::vector<corridor::Feed>& feeds) {
  std::vector<std::unique_ptr<Sink>> videos;
  if (folder.empty()) return videos;
  fs::create_directories(folder);
  for (const corridor::Feed& feed : feeds) {
    if (!feed.has_images()) continue;
    const RigCamera& camera = feed.camera();
    const draw::OverlayVideo::View view{.camera = feed.id(),
                                        .size = feed.info().size,
                                        .rate_hz = feed.info().rate_hz,
                                        .sound_of = feed.sound_source(),
                                        .offset = duration_from_seconds(camera.offset_s.value_or(0))};
    videos.push_back(std::make_unique<draw::OverlayVideo>(video_of(folder, camera), view, drawn));
  }
  return videos;
}

void add(corridor::Sinks& sinks, std::vector<std::unique_ptr<Sink>> more) {
  for (std::unique_ptr<Sink>& sink : more) sinks.add(std::move(sink));
}

corridor::Sinks sinks_of(const Rig& rig, const GroundOutput& output, const PeopleOnGroundOptions& options,
                         const std::vector<corridor::Feed>& feeds) {
  corridor::Sinks sinks;
  if (!output.boxes_of.empty()) {
    sinks.add(std::make_unique<format::tracks::ViewBoxFile>(output.tracks, id_of(rig, output.boxes_of)));
  } else if (!output.tracks.empty()) {
    const bool by_name = output.format.empty() && format::format_of_name(output.tracks, format::Content::ground) != nullptr;
    const std::string name = by_name || !output.format.empty() ? output.format : "ground";
    sinks.add(format::create_recording(output.tracks, format::format_to_write(output.tracks, name, format::Content::ground)));
  }
  draw::OverlayOptions drawn{.trail_of_centres = true};
  drawn.blur_faces = !output.blur.empty();
  std::vector<std::unique_ptr<Sink>> overlays = videos_in(output.overlays, drawn, feeds);
  if (output.numbers.empty()) {
    add(sinks, std::move(overlays));
  } else {
    sinks.add(std::make_unique<NumberSink>(output.numbers, std::move(overlays)));
  }
  drawn.bare = true;
  add(sinks, videos_in(output.copies, drawn, feeds));
  if (!output.pitch_view.empty()) {
    const reconstruct::GroundArea area = area_of(rig, options);
    const draw::ShownGround shown{area.pitch(), area.margin(), area.mirrored()};
    sinks.add(std::make_unique<draw::PitchViewVideo>(output.pitch_view, shown, feeds.front().info().rate_hz));
  }
  return sinks;
}

/// The rig's cameras, those that stand stabilised; cameras that bring detections have no images to steady.
std::vector<corridor::Feed> open_stabilised(const Rig& rig, const PeopleOnGroundOptions& options,
                                            std::vector<corridor::StabilisedCamera>& stabilise) {
  std::vector<std::optional<corridor::StabilisedCamera>> found(rig.cameras.size());
  std::vector<std::optional<corridor::Feed>> opened(rig.cameras.size());
  tbb::parallel_for(std::size_t{0}, opened.size(), [&](std::size_t i) {
    const RigCamera& camera = rig.cameras[i];
    const CameraId id{static_cast<int>(i)};
    corridor::FeedOptions how{.rate_hz = options.rate_hz};
    if (!camera.source.empty() && ptz_of(options.ptz, id) == nullptr) {
      found[i].emplace(camera, how, options.live);
      how = found[i]->feed_options();
    }
    opened[i].emplace(camera, id, how);
  });
  std::vector<corridor::Feed> feeds;
  for (auto& feed : opened) feeds.push_back(std::move(*feed));
  for (auto& camera : found) {
    if (camera) stabilise.push_back(std::move(*camera));
  }
  return feeds;
}

/// Sinks of files need the feeds, to know what to draw into.
using SinksFor = std::function<corridor::Sinks(const Rig& rig, const std::vector<corridor::Feed>& feeds)>;

GroundSummary run_over(const Rig& rig, const SinksFor& sinks_for, const PeopleOnGroundOptions& options, const Hooks& hooks) {
  std::vector<corridor::StabilisedCamera> stabilise;
  std::vector<corridor::Feed> feeds =
      options.stabilise ? open_stabilised(rig, options, stabilise) : corridor::open_feeds(rig, {.rate_hz = options.rate_hz});
  corridor::Sinks sinks = sinks_for(rig, feeds);
  const bool images = std::any_of(feeds.begin(), feeds.end(), [](const corridor::Feed& feed) { return feed.has_images(); });
  PeopleOnGroundOptions own = options;
  own.stabilise = options.stabilise && std::all_of(stabilise.begin(), stabilise.end(),
                                                   [](const corridor::StabilisedCamera& one) { return one.steadies(); });
  const auto stage = people_on_ground_again(feeds, rig, own);
  corridor::Clock clock(std::move(feeds));
  GroundSummary summary{corridor::run(*stage, clock, sinks, hooks), stage->teams()};
  for (const corridor::StabilisedCamera& camera : stabilise) camera.report(summary);
  if (!options.teams.names.empty() && !images)
    summary.warnings.push_back("teams are reported by their clothes, and there are no images: no person has a team");
  return summary;
}

GroundSummary track_timed(const Rig& rig, const SinksFor& sinks_for, const PeopleOnGroundOptions& options, const Hooks& hooks) {
  if (!lacks_offsets(rig)) return run_over(rig, sinks_for, options, hooks);
  Rig timed = rig;
  RigOffsets offsets;
  if (options.live) {
    offsets.warnings.push_back(
        "when cameras were started is not known, and live it cannot be searched for: 0 is taken; give each camera's offset_s in "
        "the "
        "rig");
  } else {
    RigOffsetsOptions how;
    how.detector = options.detector;
    how.rate_hz = options.rate_hz;
    offsets = find_rig_offsets(rig, area_of(rig, options), how, hooks);
    enter_offsets(timed, offsets);
  }
  GroundSummary summary = run_over(timed, sinks_for, options, hooks);
  summary.notes.insert(summary.notes.begin(), offsets.notes.begin(), offsets.notes.end());
  summary.warnings.insert(summary.warnings.begin(), offsets.warnings.begin(), offsets.warnings.end());
  return summary;
}

}  // namespace

GroundSummary track_ground(const Rig& rig, const GroundOutput& output, const PeopleOnGroundOptions& options, const Hooks& hooks) {
  return track_ground(rig, output, {}, options, hooks);
}

GroundSummary track_ground(const Rig& rig, const GroundOutput& output, std::vector<std::unique_ptr<Sink>> own_sinks,
                           const PeopleOnGroundOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  check(rig, output, options);
  const auto sinks_for = [&](const Rig& timed, const std::vector<corridor::Feed>& feeds) {
    corridor::Sinks sinks = sinks_of(timed, output, options, feeds);
    for (std::unique_ptr<Sink>& sink : own_sinks) sinks.add(std::move(sink));
    return sinks;
  };
  return track_timed(rig, sinks_for, options, hooks);
}

std::vector<std::string> overlays_of(const Rig& rig, const GroundOutput& output) {
  std::vector<std::string> files;
  for (const std::string& folder : {output.overlays, output.copies}) {
    if (folder.empty()) continue;
    for (const RigCamera& camera : rig.cameras) files.push_back(video_of(folder, camera));
  }
  return files;
}

}  // namespace marey::pipeline::people::ground

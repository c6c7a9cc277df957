#include "marey/pipeline/people/track_in_image.h"

#include <fstream>
#include <set>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/draw/overlay_video.h"
#include "marey/draw/plot_file.h"
#include "marey/format/recording_file.h"
#include "marey/pipeline/corridor/stabilised_camera.h"
#include "marey/pipeline/keypoints/keypoint_recording.h"
#include "marey/pipeline/people/mask_sink.h"
#include "marey/pipeline/people/number_sink.h"
#include "marey/pipeline/people/target_mask_sink.h"
#include "marey/source/open_source.h"

namespace marey::pipeline::people {
namespace {

corridor::Feed open(const ImageFeed& given, const corridor::FeedOptions& options) {
  const RigCamera& camera = given.camera;
  if (camera.source.empty() == camera.detections.empty()) throw Error("{}", "give either images or detections to track");
  if (camera.rate_hz && !(*camera.rate_hz > 0)) throw Error("the rate is {} frames a second; it must be positive", *camera.rate_hz);
  corridor::Feed feed(camera, CameraId{}, options);
  if (given.detector) feed.find(given.detector());
  return feed;
}

corridor::Sinks sinks_of(const TrackOutput& output, std::vector<std::unique_ptr<Sink>> own, const corridor::Feed& feed,
                         const draw::OverlayOptions& drawn) {
  corridor::Sinks sinks;
  for (std::unique_ptr<Sink>& sink : own) sinks.add(std::move(sink));
  if (!output.tracks.empty()) {
    const format::Format& format = format::format_to_write(output.tracks, output.format, format::Content::image);
    sinks.add(format::create_recording(output.tracks, format));
  }
  if (!output.plot.empty()) sinks.add(std::make_unique<draw::PlotFile>(output.plot));
  if (!output.masks.empty()) {
    if (!feed.has_images() || feed.detector() != nullptr)
      throw Error("{}: masks are of the background model, and detections are given", output.masks);
    sinks.add(std::make_unique<MaskSink>(output.masks));
  }
  if (!output.numbers.empty() && !feed.has_images())
    throw Error("{}: numbers are read in images, and only detections are given", output.numbers);
  if (!output.target_masks.empty()) sinks.add(std::make_unique<TargetMaskSink>(output.target_masks));
  std::vector<std::unique_ptr<Sink>> numbered;
  const draw::OverlayVideo::View view{
      .camera = feed.id(), .size = feed.info().size, .rate_hz = feed.info().rate_hz, .sound_of = feed.sound_source()};
  for (const bool bare : {false, true}) {
    const std::string& path = bare ? output.copy : output.overlay;
    if (path.empty()) continue;
    if (!feed.has_images()) throw Error("{}: {} needs images", path, bare ? "a copy of the video" : "an overlay");
    draw::OverlayOptions options = drawn;
    options.bare = bare;
    options.blur_faces = bare || output.blur_faces;
    auto video = std::make_unique<draw::OverlayVideo>(path, view, options);
    if (bare || output.numbers.empty()) {
      sinks.add(std::move(video));
    } else {
      numbered.push_back(std::move(video));
    }
  }
  if (!output.numbers.empty()) sinks.add(std::make_unique<NumberSink>(output.numbers, std::move(numbered)));
  return sinks;
}

corridor::Summary run_alone(corridor::Feed feed, corridor::Stage& stage, corridor::Sinks& sinks, const Hooks& hooks) {
  std::vector<corridor::Feed> feeds;
  feeds.push_back(std::move(feed));
  corridor::Clock clock(std::move(feeds));
  return corridor::run(stage, clock, sinks, hooks);
}

}  // namespace

corridor::Summary track_people(const RigCamera& camera, const TrackOutput& output, const ImagePeopleOptions& options,
                               const Hooks& hooks) {
  return track_people(ImageFeed{.camera = camera}, output, {}, options, hooks);
}

corridor::Summary track_people(const ImageFeed& given, const TrackOutput& output, std::vector<std::unique_ptr<Sink>> own_sinks,
                               const ImagePeopleOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  for (const std::string& masks : {output.masks, output.target_masks}) {  // before anything that takes long
    if (!masks.empty()) draw::MaskFolder::require_free(masks);
  }
  std::optional<corridor::StabilisedCamera> stabilise;
  if (options.stabilise) stabilise.emplace(given.camera, given.how, options.live);
  corridor::Feed feed = open(given, stabilise ? stabilise->feed_options() : given.how);
  corridor::Sinks sinks = sinks_of(output, std::move(own_sinks), feed, {.trail_of_centres = options.outlines.has_value()});
  ImagePeopleOptions own = options;
  if (!output.tracks.empty()) own.spill_path = output.tracks;
  own.stabilise = stabilise && stabilise->steadies();
  own.with_lines = !output.overlay.empty();
  const auto stage = people_in_image(feed, own);
  corridor::Summary summary = run_alone(std::move(feed), *stage, sinks, hooks);
  if (stabilise) stabilise->report(summary);
  return summary;
}

KeypointSequence find_keypoints(const RigCamera& camera, const ImagePeopleOptions& options, const Hooks& hooks) {
  KeypointSequence found;
  found.from = camera.source;
  std::vector<std::unique_ptr<Sink>> sinks;
  sinks.push_back(std::make_unique<keypoints::KeypointCollector>(found));
  track_people(ImageFeed{.camera = camera}, {}, std::move(sinks), options, hooks);
  return found;
}

corridor::Summary track_markers(const RigCamera& camera, const TrackOutput& output, const markers::ImageMarkerOptions& options,
                                const Hooks& hooks) {
  return track_markers(ImageFeed{.camera = camera}, output, {}, options, hooks);
}

corridor::Summary track_markers(const ImageFeed& given, const TrackOutput& output, std::vector<std::unique_ptr<Sink>> own_sinks,
                                const markers::ImageMarkerOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  corridor::Feed feed = open(given, given.how);
  corridor::Sinks sinks = sinks_of(output, std::move(own_sinks), feed, {});
  const auto stage = markers::markers_in_image(feed, options);
  return run_alone(std::move(feed), *stage, sinks, hooks);
}

std::vector<std::string> read_labels(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be read; give a text file with one name a line", path);
  std::vector<std::string> labels;
  std::set<std::string> detected;
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    line = line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
    if (!detected.insert(line).second)
      throw Error("{}:{}: the name \"{}\" occurs twice; every marker needs its own", path, line_number, line);
    labels.push_back(line);
  }
  if (labels.empty()) throw Error("{}: holds no name; write one a line", path);
  return labels;
}

cv::Mat read_mask(const std::string& path) {
  constexpr double kBlack = 8;  // what a lossy image may make of 0
  const auto frame = source::open_source(path)->next();
  if (!frame) throw Error("{}: cannot be read as an image; give a PNG in which what is to be omitted is white", path);
  cv::Mat grey;
  cv::cvtColor(frame->image.bgr(), grey, cv::COLOR_BGR2GRAY);
  return grey > kBlack;
}

}  // namespace marey::pipeline::people

#include "marey/pipeline/markers/reconstruct.h"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/markers/named_in_take.h"

namespace marey::pipeline::markers {
namespace {

/// A file that is gone with its owner.
struct ForAWhile {
  std::string path;
  ~ForAWhile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

/// Most formats begin with values available only at the end: the take is read twice.
void rewrite(const std::string& take, const std::string& out, const format::Format& format) {
  const format::WritePlan plan = format::plan_of(*format::open_recording(take), take);
  const auto reader = format::open_recording(take);
  replay(*reader, *format::create_recording(out, format, plan));
}

corridor::Clock clock_of(const Rig& rig, const std::string& observations, const MarkersInSpaceOptions& options) {
  constexpr int kAhead = 4;  // frames of each camera
  std::vector<corridor::Feed> feeds =
      observations.empty() ? corridor::open_feeds(rig, {.rate_hz = options.rate_hz, .steady_times = true, .ahead = kAhead}, true)
                           : corridor::open_observations(observations, rig, options.rate_hz);
  for (corridor::Feed& feed : feeds) {
    if (feed.has_images())
      feed.find(std::make_unique<detect::markers::MarkerDetector>(corridor::markers_of(feed.camera(), options.markers)));
  }
  return corridor::Clock(std::move(feeds), {.pace = corridor::ClockOptions::Pace::even, .interpolate = !options.live});
}

void report_cameras(const corridor::Clock& clock, const Rig& rig, corridor::Summary& summary) {
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const std::string& name = rig.cameras[c].name;
    corridor::Summary::Camera& camera = summary.cameras.emplace_back();
    camera.name = name;
    camera.frames = clock.frames(c);
    camera.missed = clock.missed(c);
    if (rig.cameras[c].camera() && clock.frames(c) == 0) {
      summary.warnings.push_back(fmt::format("camera \"{}\" gave not one frame", name));
    } else if (clock.missed(c) > 0) {
      summary.warnings.push_back(fmt::format("camera \"{}\" has no frame for {} of {} instants; the others continued without it",
                                             name, clock.missed(c), summary.frames));
    }
  }
  const auto step = [](const char* name, const StageTimes& times) {
    return corridor::Summary::StepTime{name, times.count(), times.quantile(0.5), times.quantile(0.99)};
  };
  summary.steps.insert(summary.steps.begin(), {step("decode", clock.decoding()), step("detect", clock.detecting())});
}

}  // namespace

corridor::Summary reconstruct(const Rig& rig, const std::string& observations, corridor::Sinks& sinks,
                              const MarkersInSpaceOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  corridor::Clock clock = clock_of(rig, observations, options);
  if (clock.rate_hz() <= 0) throw Error("{}", "not one frame could be read from any camera");
  const Rig fitted = corridor::rig_as_fed(rig, clock.feeds());
  MarkersInSpaceOptions named = options;
  if (named.set.labels.empty() && named.learned_set == nullptr) named.set = named_in_take(observations);
  const auto stage = markers_in_space(fitted, clock.rate_hz(), named);
  corridor::Summary summary = corridor::run(*stage, clock, sinks, hooks);
  report_cameras(clock, fitted, summary);
  return summary;
}

corridor::Summary reconstruct(const Rig& rig, const std::string& observations, const std::string& out,
                              const MarkersInSpaceOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  const format::Format& format = format::format_to_write(out, {}, format::Content::space);
  const auto record = [&](const std::string& take) {
    corridor::Sinks sinks;
    sinks.add(std::make_unique<format::take::TakeWriter>(take));
    return reconstruct(rig, observations, sinks, options, hooks);
  };
  if (format.name == "take") return record(out);
  const ForAWhile take{out + ".part.marey"};
  corridor::Summary summary = record(take.path);
  const StopScope keeps_what_there_is{{}};  // of a run that was stopped too
  rewrite(take.path, out, format);
  return summary;
}

}  // namespace marey::pipeline::markers

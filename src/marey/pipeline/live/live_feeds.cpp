#include "marey/pipeline/live/live_feeds.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/pipeline/live/live_node.h"
#include "marey/pipeline/live/live_take.h"
#include "marey/pipeline/simulate/live_simulation.h"
#include "marey/source/live/live_camera.h"

namespace marey::pipeline::live {
namespace {

constexpr double kBeforePlay = 0.3;  // s after a video or a simulation was opened until it begins
constexpr int kKeep = 8;             // frames of a camera that were not yet requested

/// A path is played.
std::string live_name(const std::string& source) {
  return scheme_of(source).empty() ? "play:" + source : source;
}

/// A camera of the rig that has no source.
class NoCamera final : public LiveSource {
 public:
  SourceInfo info() const override { return {}; }
  std::vector<CameraFrame> arrived() override { return {}; }
  bool connected() const override { return false; }
  bool ended() const override { return true; }
};

Rig cameras_of(const source::live::Address& address) {
  const std::vector<source::live::Kind> kinds = live_kinds();
  const source::live::Kind& kind = source::live::kind_of(kinds, address);
  if (kind.cameras) return kind.cameras(address);
  Rig rig;
  rig.cameras.emplace_back().source = address.text;
  return rig;
}

bool same_ground(const Rig& a, const Rig& b) {
  return a.ground_from_world == b.ground_from_world && a.ground.middle == b.ground.middle && a.ground.half == b.ground.half &&
         a.ground.terms() == b.ground.terms();
}

/// The ground that `some`, which `given` stands for, brings along is the rig's, where it brings one.
void take_ground(Rig& rig, const Rig& some, const std::string& given) {
  const auto has_ground = [](const Rig& of) { return of.ground_from_world || !of.ground.flat(); };
  if (!has_ground(some)) return;
  if (has_ground(rig) && !same_ground(rig, some))
    throw Error("{}: its ground is another one than that of the sources before it; put the cameras into one rig",
                shown_source(given));
  rig.ground_from_world = some.ground_from_world;
  rig.ground = some.ground;
}

/// When everything that is played begins: soon after it was asked for first.
std::function<Timestamp()> common_begin(std::shared_ptr<source::LiveTime> time) {
  struct Begin {
    std::mutex mutex;
    std::optional<Timestamp> at;
  };
  return [time = std::move(time), begin = std::make_shared<Begin>()] {
    const std::lock_guard lock(begin->mutex);
    if (!begin->at) begin->at = time->now() + duration_from_seconds(kBeforePlay);
    return *begin->at;
  };
}

void wait_for(const std::vector<std::unique_ptr<LiveSource>>& sources, double patience_s, const std::stop_token& stop) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience_s);
  const auto there = [](const auto& source) { return source->connected() || source->ended(); };
  while (!std::all_of(sources.begin(), sources.end(), there)) {
    if (stop.stop_requested() || std::chrono::steady_clock::now() >= end) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
}

}  // namespace

std::vector<source::live::Kind> live_kinds() {
  std::vector<source::live::Kind> kinds = source::live::camera_kinds();
  for (source::live::Kind& kind : kinds) {
    if (kind.schemes.front() == "play") kind = with_takes(std::move(kind));
  }
  kinds.push_back(node_kind());
  kinds.push_back(simulate::simulation_kind());
  return kinds;
}

Rig rig_of_sources(std::span<const std::string> sources) {
  Rig rig;
  std::set<std::string> names;
  for (const std::string& given : sources) {
    const auto sign = given.find('=');
    const bool named = scheme_of(given).empty() && sign != std::string::npos && sign > 0 &&
                       std::none_of(given.begin(), given.begin() + static_cast<std::ptrdiff_t>(sign), unfit_for_camera_name);
    Rig some = cameras_of(source::live::parse_address(live_name(named ? given.substr(sign + 1) : given)));
    take_ground(rig, some, given);
    for (RigCamera& camera : some.cameras) {
      const bool has_name = !camera.name.empty() && !names.contains(camera.name);
      if (named || !has_name) camera.name = named ? given.substr(0, sign) : fmt::format("cam{}", rig.cameras.size() + 1);
      if (named && some.cameras.size() > 1) camera.name += fmt::format("{}", rig.cameras.size() + 1);
      if (!names.insert(camera.name).second) throw Error("two cameras are called {}; each needs its own name", camera.name);
      rig.cameras.push_back(std::move(camera));
    }
  }
  return rig;
}

std::vector<corridor::Feed> open_live_feeds(const Rig& rig, const source::LivePolicy& policy, double patience_s,
                                            CameraSettings* camera_settings, const std::stop_token& stop) {
  const std::vector<source::live::Kind> kinds = live_kinds();
  const auto begin = common_begin(policy.time);
  std::vector<source::live::Connect> connects(rig.cameras.size());
  for (std::size_t i = 0; i < rig.cameras.size(); ++i) {
    const RigCamera& camera = rig.cameras[i];
    if (camera.source.empty()) continue;
    try {
      const auto address = source::live::parse_address(live_name(camera.source));
      connects[i] = source::live::kind_of(kinds, address).open(address, {policy.time, begin, camera.rate_hz});
    } catch (const Error& error) {
      throw Error("{}", corridor::stated_of(camera, error.what()));
    }
  }
  std::vector<std::unique_ptr<LiveSource>> sources;
  for (std::size_t i = 0; i < connects.size(); ++i) {
    if (!connects[i]) {
      sources.push_back(std::make_unique<NoCamera>());
      continue;
    }
    auto controls = camera_settings != nullptr ? camera_settings->controls(i) : controls_of(rig.cameras[i]);
    sources.push_back(source::live::keep_connected(shown_source(rig.cameras[i].source), connects[i], policy.time,
                                                   {.keep = kKeep, .controls = std::move(controls)}));
  }
  if (std::none_of(connects.begin(), connects.end(), [](const auto& connect) { return connect != nullptr; }))
    throw Error("{}", "no camera of the rig has a source; name them in the rig, or give CAMERA=SOURCE");
  wait_for(sources, patience_s, stop);
  std::vector<corridor::Feed> feeds;
  for (std::size_t i = 0; i < sources.size(); ++i) {
    feeds.push_back(corridor::Feed::live(rig.cameras[i], CameraId{static_cast<int>(i)}, std::move(sources[i])));
    if (camera_settings != nullptr) camera_settings->fit(i, feeds.back().camera());
  }
  return feeds;
}

}  // namespace marey::pipeline::live

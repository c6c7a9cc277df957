// Names of markers behind bars, over scenes of every kind: exact points of two markers from opposite sides, hidden at once.
//
//   picture_names [--videos N] [--first-seed N] [--detect] [--kind NAME] [--which]
//
// Each row is a kind of scene; its figures are videos in which a marker loses its name, beside those that a plain tracker (constant
// velocity that never stops coasting, the Hungarian method) loses on the same points. With --detect both see rendered images,
// each through its own detector. --which names the seeds that ours lost.
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "marey/detect/markers/marker_detector.h"
#include "marey/evaluate/label_loss.h"
#include "marey/simulate/markers/marker_scene.h"
#include "marey/simulate/random.h"
#include "marey/track/roster/roster_tracker.h"

#include "experiments/markdown_table.h"
#include "experiments/plain_markers.h"

namespace {

using namespace marey;
using simulate::markers::MarkerScene;
using simulate::markers::MarkerSceneOptions;
using simulate::markers::MarkerSituation;
using Detected = std::vector<Observation<2>>;
using Named = std::vector<std::vector<evaluate::NamedPosition>>;

struct Kind {
  const char* name;
  MarkerSituation situation;
  MarkerSceneOptions options;
  double off = 0.1;  // px that exact points are off by
};

std::vector<Kind> kinds() {
  const auto with = [](auto&& change) {
    MarkerSceneOptions options;
    change(options);
    return options;
  };
  constexpr auto kOne = MarkerSituation::bar, kTwo = MarkerSituation::opposite;
  return {
      {"one marker, one bar", kOne, {}},
      {"two markers, one bar", kTwo, {}},
      {"two bars", kTwo, with([](auto& o) { o.bars = 2; })},
      {"25 Hz", kTwo, with([](auto& o) { o.rate_hz = 25; })},
      {"60 Hz, same seconds", kTwo, with([](auto& o) { o.rate_hz = 60, o.pace = 0.5; })},
      {"120 Hz, same seconds", kTwo, with([](auto& o) { o.rate_hz = 120, o.pace = 0.25; })},
      {"200 Hz, same seconds", kTwo, with([](auto& o) { o.rate_hz = 200, o.pace = 0.15; })},
      {"120 Hz, same frames", kTwo, with([](auto& o) { o.rate_hz = 120; })},
      {"200 Hz, same frames", kTwo, with([](auto& o) { o.rate_hz = 200; })},
      {"half a pixel of noise", kTwo, {}, 0.5},
      {"5 markers", kTwo, with([](auto& o) { o.markers = 5; })},
      {"10 markers", kTwo, with([](auto& o) { o.markers = 10; })},
      {"discs of 2 px", kTwo, with([](auto& o) { o.radius_px = 2; })},
      {"discs of 9 px", kTwo, with([](auto& o) { o.radius_px = 9; })},
      {"1280 x 1024", kTwo, with([](auto& o) { o.size = {1280, 1024}; })},
  };
}

bool any_lost(const MarkerScene& scene, const Named& named) {
  std::vector<std::vector<evaluate::NamedPosition>> truth(scene.frames.size());
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const auto& marker : scene.frames[i]) {
      if (marker.visible) truth[i].push_back({std::to_string(marker.marker), marker.position});
    }
  }
  for (const auto& fate : evaluate::evaluate_labels(truth, named, 1.5 * scene.options.radius_px + 2)) {
    if (std::atoi(fate.marker.c_str()) < 2 && fate.lost()) return true;  // others move plainly, and come and go
  }
  return false;
}

Detected exact(const MarkerScene& scene, std::size_t frame, double off, simulate::Random& random) {
  Detected detected;
  for (const auto& marker : scene.frames[frame]) {
    if (!marker.visible) continue;
    Observation<2>& point = detected.emplace_back();
    point.value = marker.position + off * Vector<2>(random.gaussian(), random.gaussian());
    point.covariance = off * off * Matrix<2>::Identity();
  }
  return detected;
}

struct Lost {
  int ours = 0, peer = 0;
};

void run(const Kind& kind, std::uint64_t seed, bool detect, Lost& lost) {
  const MarkerScene scene = simulate_markers(kind.situation, seed, kind.options);
  const auto tracker = track::roster::make_roster_tracker<2>({});
  detect::markers::MarkerDetector detector{detect::markers::MarkerOptions{}};
  experiments::PlainTracker peer;
  simulate::Random random(seed);
  Named ours(scene.frames.size()), peers(scene.frames.size());
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const Timestamp now = timestamp_from_seconds(static_cast<double>(i) / kind.options.rate_hz);
    Detected detected, plain;
    if (detect) {
      const cv::Mat image = render_frame(scene, static_cast<int>(i));
      std::vector<Expected> expected;
      for (const Track<2>& track : tracker->expected(now)) expected.push_back({*track.box});
      const Frame frame{CameraId{}, static_cast<std::int64_t>(i), now, Image(image)};
      for (const Detection& detection : detector.detect(frame, expected).detections) detected.push_back(observation_of(detection));
      plain = experiments::plain_detections(image);
    } else {
      plain = detected = exact(scene, i, kind.off, random);
    }
    for (const Track<2>& track : tracker->step(now, detected)) {
      if (!track.confirmed) continue;
      ours[i].push_back(
          {std::to_string(number(track.id)), track.observation ? detected[*track.observation].value : track.position});
    }
    peers[i] = peer.step(plain);
  }
  lost.ours += any_lost(scene, ours);
  lost.peer += any_lost(scene, peers);
}

}  // namespace

int main(int count, char** words) {
  int videos = 200;
  std::uint64_t first = 1;
  bool detect = false, which = false;
  std::string only;
  CLI::App app("Names of markers behind bars, beside a plain tracker");
  app.add_option("--videos", videos);
  app.add_option("--first-seed", first);
  app.add_option("--kind", only);
  app.add_flag("--detect", detect);
  app.add_flag("--which", which);
  CLI11_PARSE(app, count, words);
  std::printf("%s", experiments::markdown_header({"scene", "videos", "Marey", "plain tracker"}).c_str());
  for (const Kind& kind : kinds()) {
    if (!only.empty() && only != kind.name) continue;
    Lost lost;
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(videos); ++seed) {
      const int before = lost.ours;
      run(kind, seed, detect, lost);
      if (which && lost.ours > before) std::fprintf(stderr, "%s, lost: %llu\n", kind.name, static_cast<unsigned long long>(seed));
    }
    const std::vector<std::string> cells{kind.name, std::to_string(videos), std::to_string(lost.ours), std::to_string(lost.peer)};
    std::printf("%s", experiments::markdown_row(cells).c_str());
    std::fflush(stdout);
  }
  return 0;
}

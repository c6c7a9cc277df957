#include "experiments/marker_names.h"

#include <algorithm>
#include <array>
#include <mutex>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/detect/markers/marker_detector.h"
#include "marey/evaluate/label_loss.h"
#include "marey/simulate/markers/marker_scene.h"
#include "marey/simulate/random.h"
#include "marey/track/roster/roster_tracker.h"

#include "experiments/markdown_table.h"
#include "experiments/plain_markers.h"

namespace marey::experiments {
namespace {

using simulate::markers::MarkerScene;
using simulate::markers::MarkerSituation;
using Detected = std::vector<Observation<2>>;
using Named = std::vector<std::vector<evaluate::NamedPosition>>;

struct SceneKind {
  std::string name;
  MarkerSituation situation;
  int clutter = 0;
};

std::vector<SceneKind> scene_kinds(const std::string& only) {
  std::vector<SceneKind> kinds{{"bar", MarkerSituation::bar}, {"opposite", MarkerSituation::opposite}};
  for (const auto& named : simulate::markers::marker_situations()) {
    if (named.situation == MarkerSituation::plain) continue;
    kinds.push_back({fmt::format("{}, 2 false lights", named.name), named.situation, 2});
  }
  std::erase_if(kinds, [&](const SceneKind& kind) { return kind.name.find(only) == std::string::npos; });
  return kinds;
}

bool any_lost(const MarkerScene& scene, const Named& named) {
  std::vector<std::vector<evaluate::NamedPosition>> truth(scene.frames.size());
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const auto& marker : scene.frames[i]) {
      if (marker.visible) truth[i].push_back({std::to_string(marker.marker), marker.position});
    }
  }
  const auto fates = evaluate::evaluate_labels(truth, named, 1.5 * scene.options.radius_px);
  return std::any_of(fates.begin(), fates.end(), [](const evaluate::LabelFate& fate) { return fate.lost(); });
}

/// The true places, off by a tenth of a pixel, and the false lights.
std::vector<Detected> exact_points(const MarkerScene& scene) {
  constexpr double kOff = 0.1;  // px
  simulate::Random random(scene.seed);
  std::vector<Detected> frames(scene.frames.size());
  const auto add = [&](Detected& detected, const Vector<2>& location) {
    Observation<2> point;
    point.value = location + kOff * Vector<2>(random.gaussian(), random.gaussian());
    point.covariance = kOff * kOff * Matrix<2>::Identity();
    detected.push_back(point);
  };
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    for (const auto& marker : scene.frames[i]) {
      if (marker.visible) add(frames[i], marker.position);
    }
    for (const Vector<2>& light : scene.clutter[i]) add(frames[i], light);
  }
  return frames;
}

bool peer_loses(const MarkerScene& scene, const std::vector<Detected>& frames) {
  PlainTracker tracker;
  Named named;
  for (const Detected& detected : frames) named.push_back(tracker.step(detected));
  return any_lost(scene, named);
}

/// Tracks `frames`, or with no frames the images themselves through the detector.
bool marey_loses(const MarkerScene& scene, const std::vector<Detected>& frames) {
  const auto tracker = track::roster::make_roster_tracker<2>({});
  detect::markers::MarkerDetector detector{detect::markers::MarkerOptions{}};
  Named named(scene.frames.size());
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const Timestamp now = timestamp_from_seconds(static_cast<double>(i) / scene.options.rate_hz);
    Detected detected;
    if (frames.empty()) {
      std::vector<Expected> expected;
      for (const Track<2>& track : tracker->expected(now)) expected.push_back({*track.box});
      const int index = static_cast<int>(i);
      const Frame frame{CameraId{}, index, now, Image(render_frame(scene, index))};
      for (const Detection& detection : detector.detect(frame, expected).detections) detected.push_back(observation_of(detection));
    } else {
      detected = frames[i];
    }
    for (const Track<2>& track : tracker->step(now, detected)) {
      if (track.confirmed)
        named[i].push_back(
            {std::to_string(number(track.id)), track.observation ? detected[*track.observation].value : track.position});
    }
  }
  return any_lost(scene, named);
}

std::array<bool, 4> losses(const SceneKind& kind, std::uint64_t seed) {
  simulate::markers::MarkerSceneOptions options;
  options.clutter = kind.clutter;
  const MarkerScene scene = simulate_markers(kind.situation, seed, options);
  const std::vector<Detected> exact = exact_points(scene);
  std::vector<Detected> plain;
  for (int i = 0; i < static_cast<int>(scene.frames.size()); ++i) plain.push_back(plain_detections(render_frame(scene, i)));
  return {marey_loses(scene, {}), marey_loses(scene, exact), peer_loses(scene, plain), peer_loses(scene, exact)};
}

}  // namespace

std::vector<MarkerNamesRow> run_marker_names(const MarkerNamesOptions& options) {
  const std::vector<SceneKind> kinds = scene_kinds(options.only);
  std::vector<MarkerNamesRow> rows;
  const int all = static_cast<int>(kinds.size()) * options.videos;
  int done = 0;
  std::mutex adding;
  for (const SceneKind& kind : kinds) {
    MarkerNamesRow row{kind.name, options.videos};
    tbb::parallel_for(0, options.videos, [&](int video) {
      const auto lost = losses(kind, options.seed + static_cast<std::uint64_t>(video));
      const std::lock_guard lock(adding);
      row.lost += lost[0] ? 1 : 0;
      row.lost_exact += lost[1] ? 1 : 0;
      row.peer_lost += lost[2] ? 1 : 0;
      row.peer_lost_exact += lost[3] ? 1 : 0;
      if (options.progress) options.progress(++done, all);
    });
    rows.push_back(row);
  }
  return rows;
}

std::string to_text(const std::vector<MarkerNamesRow>& rows) {
  std::string text = fmt::format("{:30} {:>7} {:>15} {:>13}   peer: {:>15} {:>13}\n", "names lost", "videos", "from images",
                                 "exact points", "from images", "exact points");
  for (const MarkerNamesRow& row : rows) {
    text += fmt::format("{:30} {:7} {:15} {:13}         {:15} {:13}\n", row.scene, row.videos, row.lost, row.lost_exact,
                        row.peer_lost, row.peer_lost_exact);
  }
  return text;
}

std::string to_markdown(const std::vector<MarkerNamesRow>& rows) {
  std::string text = markdown_header({"scene", "videos", "Marey, from images", "Marey, exact points", "plain tracker, from images",
                                      "plain tracker, exact points"});
  for (const MarkerNamesRow& row : rows) {
    text += markdown_row({row.scene, std::to_string(row.videos), std::to_string(row.lost), std::to_string(row.lost_exact),
                          std::to_string(row.peer_lost), std::to_string(row.peer_lost_exact)});
  }
  return text;
}

}  // namespace marey::experiments

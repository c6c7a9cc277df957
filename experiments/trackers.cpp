#include "experiments/trackers.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <mutex>
#include <numeric>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "marey/core/observation.h"
#include "marey/detect/markers/marker_detector.h"
#include "marey/evaluate/label_loss.h"
#include "marey/filter/filters.h"
#include "marey/pipeline/corridor/simulation_files.h"
#include "marey/simulate/markers/marker_scene.h"
#include "marey/source/video_source.h"
#include "marey/track/roster/roster_tracker.h"

#include "experiments/independent_tracker.h"

namespace marey::experiments {
namespace {

/// A folder for the videos, removed with everything in it.
class TemporaryFolder {
 public:
  TemporaryFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("marey-experiment-{}", ::getpid())) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

struct TrackerMethod {
  std::string name;
  std::function<std::unique_ptr<track::Tracker<2>>()> make;
};

TrackerMethod alone(std::string name, const filter::FilterOptions& options) {
  return {std::move(name), [options] { return std::make_unique<IndependentTracker>(options); }};
}

/// The paper's three, with its parameters; every other filter in their place; and Marey's own tracker.
std::vector<TrackerMethod> tracker_methods() {
  std::vector<TrackerMethod> list{alone("alpha-beta (paper)", filter::AlphaBetaOptions{}),
                                  alone("Kalman (paper)", filter::KalmanPaperOptions{}),
                                  alone("CONDENSATION (paper)", filter::CondensationOptions{})};
  for (const filter::NamedFilter& filter : filter::named_filters()) {
    const std::string_view name = filter.name;
    if (name == "alpha-beta" || name == "kalman-paper" || name == "condensation") continue;
    list.push_back(alone(std::string(name), filter.options));
  }
  list.push_back({"Marey", [] { return track::roster::make_roster_tracker<2>({}); }});
  return list;
}

/// What the detector finds in a video, frame by frame.
struct ObservedMarkers {
  std::vector<Timestamp> times;
  std::vector<std::vector<Observation<2>>> frames;
};

/// Decodes a video and searches for markers in each frame. Throws Error if it cannot be read.
ObservedMarkers observe_markers(const std::string& path) {
  ObservedMarkers detected;
  const std::unique_ptr<Source> source = source::open_video(path);
  detect::markers::MarkerDetector detector{detect::markers::MarkerOptions{}};
  while (const auto frame = source->next()) {
    detected.times.push_back(frame->time);
    auto& observations = detected.frames.emplace_back();
    for (const Detection& detection : detector.detect(*frame, {}).detections) observations.push_back(observation_of(detection));
  }
  return detected;
}

struct Video {
  simulate::markers::MarkerScene scene;
  ObservedMarkers detected;
};

Video make_video(simulate::markers::MarkerSituation situation, std::uint64_t seed,
                 const simulate::markers::MarkerSceneOptions& options, const std::string& path) {
  Video video{simulate::markers::simulate_markers(situation, seed, options), {}};
  pipeline::corridor::video_markers(video.scene, path);
  video.detected = observe_markers(path);
  return video;
}

/// What one method made of one video.
struct TrackOutcome {
  bool lost = false;
  std::vector<double> errors;  ///< px, of the predictions for the first marker
};

TrackOutcome track(const Video& video, track::Tracker<2>& tracker) {
  std::vector<std::vector<evaluate::NamedPosition>> truth(video.detected.frames.size()), named(video.detected.frames.size());
  TrackOutcome outcome;
  for (std::size_t i = 0; i < video.detected.frames.size(); ++i) {
    for (const simulate::markers::MarkerTruth& marker : video.scene.frames[i]) {
      if (marker.visible) truth[i].push_back({std::to_string(marker.marker), marker.position});
    }
    const auto& detected = video.detected.frames[i];
    Vector<2> predicted = Vector<2>::Zero();
    bool is_predicted = false;
    if (i > 0) {
      const auto ahead = tracker.expected(video.detected.times[i]);
      is_predicted = !ahead.empty();
      if (is_predicted) predicted = ahead.front().position;
    }
    const auto tracks = tracker.step(video.detected.times[i], detected);
    for (const Track<2>& track : tracks) {
      if (track.confirmed)
        named[i].push_back(
            {std::to_string(number(track.id)), track.observation ? detected[*track.observation].value : track.position});
    }
    if (is_predicted && !tracks.empty() && tracks.front().observation) {
      outcome.errors.push_back((detected[*tracks.front().observation].value - predicted).norm());
    }
  }
  const double reach = 1.5 * video.scene.options.radius_px;
  for (const evaluate::LabelFate& fate : evaluate::evaluate_labels(truth, named, reach)) outcome.lost = outcome.lost || fate.lost();
  return outcome;
}

PredictionError summarise(const std::vector<double>& errors) {
  constexpr double kSigmas99 = 2.5758;  // of a normal distribution: two-sided 99 %
  PredictionError result;
  result.samples = std::ssize(errors);
  if (errors.empty()) return result;
  const double n = static_cast<double>(errors.size());
  result.mean = std::accumulate(errors.begin(), errors.end(), 0.0) / n;
  double squares = 0;
  for (const double error : errors) squares += (error - result.mean) * (error - result.mean);
  const double half = errors.size() > 1 ? kSigmas99 * std::sqrt(squares / (n - 1) / n) : 0;
  result.low = result.mean - half;
  result.high = result.mean + half;
  return result;
}

StepTime time_steps(const Video& video, track::Tracker<2>& tracker) {
  std::vector<double> times;
  for (std::size_t i = 0; i < video.detected.frames.size(); ++i) {
    const auto before = std::chrono::steady_clock::now();
    tracker.step(video.detected.times[i], video.detected.frames[i]);
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - before).count());
  }
  std::sort(times.begin(), times.end());
  const auto at = [&](double fraction) {
    return times[static_cast<std::size_t>(std::lround(fraction * static_cast<double>(times.size() - 1)))];
  };
  return {static_cast<int>(video.scene.frames.front().size()), at(0.05), at(0.5), at(0.95), times.back()};
}

constexpr std::array<simulate::markers::MarkerSituation, TrackerRow::kSituations> kSituations{
    simulate::markers::MarkerSituation::slow_zigzag, simulate::markers::MarkerSituation::rapid_zigzag,
    simulate::markers::MarkerSituation::acceleration, simulate::markers::MarkerSituation::occlusion,
    simulate::markers::MarkerSituation::crossing};

/// Tables I–VII as printed.
std::vector<TrackerRow> paper_rows() {
  using Losses = std::array<std::optional<int>, TrackerRow::kSituations>;
  return {
      {"alpha-beta, in the paper",
       Losses{3, 9, 4, 7, 9},
       {PredictionError{1445, 6.67, 7.21, 7.75}, PredictionError{594, 9.77, 10.81, 11.84}, PredictionError{1360, 2.86, 3.17, 3.48}},
       {{1, 0.043, 0.046, 0.053, 0.077},
        {5, 0.064, 0.067, 0.084, 0.104},
        {10, 0.086, 0.091, 0.110, 0.116},
        {15, 0.109, 0.113, 0.126, 0.218},
        {20, 0.130, 0.140, 0.155, 0.221},
        {25, 0.136, 0.164, 0.184, 0.211},
        {30, 0.168, 0.194, 0.214, 0.274}}},
      {"Kalman, in the paper",
       Losses{0, 0, 1, 6, 11},
       {PredictionError{1700, 9.71, 10.31, 10.91}, PredictionError{1080, 14.03, 14.98, 15.93},
        PredictionError{1615, 5.50, 5.98, 6.47}},
       {{1, 0.067, 0.077, 0.100, 0.126},
        {5, 0.120, 0.130, 0.148, 0.174},
        {10, 0.172, 0.175, 0.195, 0.268},
        {15, 0.226, 0.234, 0.256, 0.331},
        {20, 0.293, 0.296, 0.314, 0.386},
        {25, 0.338, 0.356, 0.376, 0.453},
        {30, 0.409, 0.418, 0.445, 0.503}}},
      {"CONDENSATION, in the paper",
       Losses{0, 4, 2, 8, 16},
       {PredictionError{1700, 38.51, 39.18, 39.83}, PredictionError{864, 38.77, 40.02, 41.27},
        PredictionError{1530, 21.82, 22.67, 23.51}},
       {{1, 0.134, 0.146, 0.162, 0.180},
        {5, 0.387, 0.499, 0.529, 0.801},
        {10, 0.824, 0.950, 1.017, 1.095},
        {15, 0.958, 1.384, 1.423, 1.604},
        {20, 1.285, 1.842, 1.920, 2.116},
        {25, 1.560, 1.934, 2.333, 2.427},
        {30, 1.886, 2.105, 2.791, 2.812}}}};
}

}  // namespace

TrackerExperiment run_tracker_experiment(const TrackerExperimentOptions& options, const Hooks& hooks) {
  TrackerExperiment experiment{options.videos, options.seed, paper_rows(), {}};
  const std::vector<TrackerMethod> all_methods = tracker_methods();
  for (const TrackerMethod& method : all_methods) experiment.ours.push_back({method.name, {}, {}, {}});
  const TemporaryFolder folder;
  const int all = options.videos * static_cast<int>(kSituations.size()) + static_cast<int>(options.timed_markers.size());
  int done = 0;
  const auto notify = [&] {
    ++done;
    hooks.advance({"videos", done, all});
  };

  for (std::size_t s = 0; s < kSituations.size(); ++s) {
    // Videos are independent; what results from each is put together in their order.
    std::vector<std::vector<TrackOutcome>> outcomes(static_cast<std::size_t>(options.videos));
    std::mutex telling;
    tbb::parallel_for(0, options.videos, [&](int v) {
      const auto seed = options.seed + static_cast<std::uint64_t>(v);
      const Video video = make_video(kSituations[s], seed, {}, folder.file(fmt::format("{}_{}.mp4", s, seed)));
      for (const TrackerMethod& method : all_methods) outcomes[static_cast<std::size_t>(v)].push_back(track(video, *method.make()));
      const std::lock_guard lock(telling);
      notify();
    });
    for (std::size_t m = 0; m < all_methods.size(); ++m) {
      int losses = 0;
      std::vector<double> errors;
      for (const auto& of_video : outcomes) {
        losses += of_video[m].lost ? 1 : 0;
        if (!of_video[m].lost) errors.insert(errors.end(), of_video[m].errors.begin(), of_video[m].errors.end());
      }
      experiment.ours[m].losses[s] = losses;
      if (s < TrackerRow::kMotions && !errors.empty()) experiment.ours[m].errors[s] = summarise(errors);
    }
  }
  for (const int markers : options.timed_markers) {
    simulate::markers::MarkerSceneOptions scene;
    scene.markers = markers;
    const Video video = make_video(simulate::markers::MarkerSituation::plain, options.seed, scene, folder.file("timed.mp4"));
    for (std::size_t m = 0; m < all_methods.size(); ++m) {
      experiment.ours[m].times.push_back(time_steps(video, *all_methods[m].make()));
    }
    notify();
  }
  return experiment;
}

}  // namespace marey::experiments

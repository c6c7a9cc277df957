// Names of markers in space: how often a marker of a body has a wrong name, beside a plain tracker on the same points.
//
//   space_names [--motion walk|run|kneel] [--cameras N] [--markers N] [--gaps SHARE] [--seconds S] [--rate HZ]
//               [--noise PX] [--seeds N] [--first-seed N] [--live] [--events]
//
// A track is at home on the marker that it was on the longest. `wrong` counts how often a marker had a track that is at home on
// another for 0.1 s and more; `swapped` the markers that do so at the end; `renamed` the tracks that a marker had beside one of its
// own; `told` of all markers and frames those with a measured point. The peer follows the same true places, where our
// reconstruction found a point: constant velocity, never given up, the Hungarian method, a gate that grows with the time unseen.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "marey/assign/linear_assignment.h"
#include "marey/pipeline/markers/markers_in_space.h"
#include "marey/simulate/room/room.h"

namespace {

using namespace marey;

constexpr double kReach = 0.03;      // m from the true marker that a point may be, to be that marker's
constexpr double kLongEnough = 0.1;  // s that a wrong name must last to be counted

/// Follows which track is on each marker. A track is at home on the marker that it was on the longest.
class NameEvaluate {
 public:
  NameEvaluate(std::size_t markers, double rate_hz) : rate_hz_(rate_hz), detected_(markers) {}

  void observe_frame(std::int64_t frame, int track, const Vector<3>& location, const std::vector<Vector<3>>& truth) {
    std::size_t nearest = 0;
    for (std::size_t m = 1; m < truth.size(); ++m) {
      if ((truth[m] - location).squaredNorm() < (truth[nearest] - location).squaredNorm()) nearest = m;
    }
    if ((truth[nearest] - location).norm() > kReach) {
      ++nowhere_;
      return;
    }
    detected_[nearest].push_back({static_cast<std::int32_t>(frame), track});
    ++reported_;
  }

  struct Verdict {
    int wrong = 0;    ///< times that a marker had a name that is at home elsewhere, for kLongEnough and more
    int early = 0;    ///< of these, in the first three seconds
    int swapped = 0;  ///< markers that have such a name at the end
    int renamed = 0;  ///< names that markers had beside their main ones, of their own
  };

  Verdict verdict(bool events) const {
    std::map<int, std::map<std::size_t, int>> on;
    for (std::size_t m = 0; m < detected_.size(); ++m) {
      for (const Detected& detected : detected_[m]) ++on[detected.track][m];
    }
    std::map<int, std::size_t> home;
    std::map<std::size_t, int> names;
    for (const auto& [track, markers] : on) {
      const auto maximum = std::max_element(markers.begin(), markers.end(), [](auto& p, auto& q) { return p.second < q.second; });
      home[track] = maximum->first;
      names[maximum->first] += maximum->second >= kLongEnough * rate_hz_;
    }
    Verdict verdict;
    for (const auto& [marker, count] : names) verdict.renamed += std::max(0, count - 1);
    for (std::size_t m = 0; m < detected_.size(); ++m) {
      int run = 0, counted_track = 0;
      for (const Detected& detected : detected_[m]) {
        run = home[detected.track] == m ? 0 : run + 1;
        if (run == 0) counted_track = 0;
        if (run < kLongEnough * rate_hz_ || counted_track != 0) continue;
        counted_track = detected.track;
        ++verdict.wrong;
        verdict.early += detected.frame < 3 * rate_hz_;
        if (events)
          std::printf("        %8.2f s: marker %zu bears %d, which is at home on %zu\n", detected.frame / rate_hz_, m,
                      detected.track, home[detected.track]);
      }
      verdict.swapped += run >= kLongEnough * rate_hz_;
    }
    return verdict;
  }

  std::int64_t reported() const { return reported_; }
  std::int64_t nowhere() const { return nowhere_; }

 private:
  struct Detected {
    std::int32_t frame;
    int track;
  };
  double rate_hz_;
  std::vector<std::vector<Detected>> detected_;  // by marker
  std::int64_t reported_ = 0, nowhere_ = 0;
};

/// The obvious method.
class PlainTracker {
 public:
  /// Tracks by place; those that are given no point keep going as they went.
  void step(double dt, const std::vector<Vector<3>>& points, std::int64_t frame, NameEvaluate& assess,
            const std::vector<Vector<3>>& truth) {
    std::vector<double> costs;
    for (Target& target : targets_) {
      target.location += dt * target.velocity;
      target.unobserved += dt;
      const double gate = 0.02 + 1.0 * target.unobserved;
      for (const Vector<3>& point : points) {
        const double away = (point - target.location).norm();
        costs.push_back(away < gate ? away : kNever);
      }
    }
    std::vector<char> taken(points.size(), 0);
    const auto columns = assigner_.assign(static_cast<int>(targets_.size()), static_cast<int>(points.size()), costs);
    for (std::size_t i = 0; i < targets_.size(); ++i) {
      if (columns[i] == assign::kNoIndex) continue;
      const auto column = static_cast<std::size_t>(columns[i]);
      if (costs[i * points.size() + column] >= kNever) continue;
      Target& target = targets_[i];
      const Vector<3> off = points[column] - target.location;
      target.velocity += (target.unobserved < 1.5 * dt ? 0.3 / dt : 0.3 / target.unobserved) * off;
      target.location = points[column];
      target.unobserved = 0;
      taken[column] = 1;
      assess.observe_frame(frame, static_cast<int>(i), target.location, truth);
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!taken[i] && targets_.size() < truth.size()) targets_.push_back({points[i], Vector<3>::Zero(), 0});
    }
  }

 private:
  static constexpr double kNever = 1e6;
  struct Target {
    Vector<3> location, velocity;
    double unobserved = 0;  // s
  };
  std::vector<Target> targets_;
  assign::LinearAssigner assigner_;
};

FrameSet frame_set_of(const simulate::room::RoomFrame& detected) {
  FrameSet set;
  set.index = detected.index;
  set.time = timestamp_from_seconds(detected.time_s);
  for (std::size_t c = 0; c < detected.detected.size(); ++c) {
    CameraFrame& camera = set.cameras.emplace_back().emplace();
    camera.frame.camera = CameraId{static_cast<int>(c)};
    camera.frame.index = detected.index;
    camera.frame.time = set.time;
    camera.detections.emplace();
    for (const simulate::room::RoomBlob& blob : detected.detected[c]) {
      Detection& detection = camera.detections->emplace_back();
      detection.centre = blob.pixel;
      detection.area = 0;
      detection.box = Box::from_centre(blob.pixel, 0, 0);
    }
    set.states.push_back(FeedState::live);
  }
  return set;
}

struct Result {
  NameEvaluate::Verdict ours, peer;
  double reported = 0, nowhere = 0, impure[3] = {0, 0, 0};  // %, of all markers and frames; of points of 2, 3, more rays
};

Result assess(const simulate::room::RoomOptions& options, bool live, bool events) {
  const simulate::room::RoomScene scene(options);
  pipeline::markers::MarkersInSpaceOptions space;
  space.live = live;
  const auto stage = pipeline::markers::markers_in_space(scene.rig(), options.rate_hz, space);
  const std::size_t markers = scene.labels().size();
  NameEvaluate ours(markers, options.rate_hz), peers(markers, options.rate_hz);
  PlainTracker peer;
  std::deque<simulate::room::RoomFrame> waiting;
  double all[3] = {}, impure[3] = {};
  const auto inspect = [&](const Instant& instant) {
    const simulate::room::RoomFrame frame = std::move(waiting.front());
    waiting.pop_front();
    std::vector<Vector<3>> points;
    for (const Sample& sample : instant.samples) {
      if (!sample.measured()) continue;
      ours.observe_frame(instant.index, number(sample.track), sample.position, frame.points);
      points.push_back(sample.position);
      std::set<int> owners;
      int rays = 0;
      std::size_t next = 0;
      for (const auto& camera : frame.detected) {
        for (const auto& blob : camera) {
          if (instant.detected[next++].track == sample.track) owners.insert(blob.marker.value_or(-1)), ++rays;
        }
      }
      const int kind = std::clamp(rays - 2, 0, 2);
      ++all[kind];
      impure[kind] += owners.size() > 1;
    }
    peer.step(1 / options.rate_hz, points, instant.index, peers, frame.points);
  };
  for (std::int64_t i = 0; i < options.frames; ++i) {
    waiting.push_back(scene.frame(i));
    for (const Instant& instant : stage->step(frame_set_of(waiting.back()))) inspect(instant);
  }
  if (const auto rest = stage->finish({})) {
    while (const auto instant = rest->next()) inspect(*instant);
  }
  pipeline::corridor::Summary summary;
  stage->report(summary);
  for (const std::string& warning : summary.warnings) std::printf("        %s\n", warning.c_str());
  if (events) std::printf("        noise %.3f px\n", summary.points.value().noise_px);
  Result result{ours.verdict(events), peers.verdict(false)};
  const double maximum = static_cast<double>(options.frames) * static_cast<double>(markers);
  result.reported = 100 * static_cast<double>(ours.reported()) / maximum;
  result.nowhere = 100 * static_cast<double>(ours.nowhere()) / maximum;
  for (int i = 0; i < 3; ++i) result.impure[i] = 100 * impure[i] / std::max(1.0, all[i]);
  return result;
}

struct Plan {
  simulate::room::RoomOptions room;
  double duration_s = 60;
  int seeds = 5;
  std::uint64_t first_seed = 1;
  bool live = false, events = false;
};

void add_options(CLI::App& app, Plan& plan) {
  plan.room.dropped = plan.room.ghosts = plan.room.gap_fraction = 0.05;
  std::map<std::string, simulate::room::RoomMotion> motions;
  for (const auto& named : simulate::room::room_motions()) motions[std::string(named.name)] = named.motion;
  app.add_option("--motion", plan.room.motion)->transform(CLI::CheckedTransformer(motions));
  app.add_option("--cameras", plan.room.cameras);
  app.add_option("--markers", plan.room.markers);
  app.add_option("--gaps", plan.room.gap_fraction);
  app.add_option("--seconds", plan.duration_s);
  app.add_option("--rate", plan.room.rate_hz);
  app.add_option("--noise", plan.room.noise_px);
  app.add_option("--seeds", plan.seeds);
  app.add_option("--first-seed", plan.first_seed);
  app.add_flag("--live", plan.live);
  app.add_flag("--events", plan.events);
}

void print_heading(const Plan& plan) {
  const auto& room = plan.room;
  std::printf("%d cameras, %d markers, %g Hz, %g s, %g px, dropped %g, ghosts %g, gaps %g up to %g s%s\n", room.cameras,
              room.markers, room.rate_hz, plan.duration_s, room.noise_px, room.dropped, room.ghosts, room.gap_fraction, room.gap_s,
              plan.live ? ", live" : "");
  std::printf("%6s %7s %7s %7s %7s %7s %8s %22s   peer: %7s %7s %7s\n", "seed", "wrong", "early", "swapped", "renamed", "told %",
              "nowhere", "mixed of 2, 3, 4 rays", "wrong", "swapped", "renamed");
}

void print(std::uint64_t seed, const Result& result) {
  std::printf("%6llu %7d %7d %7d %7d %7.2f %8.3f %8.2f %6.2f %6.2f         %7d %7d %7d\n", static_cast<unsigned long long>(seed),
              result.ours.wrong, result.ours.early, result.ours.swapped, result.ours.renamed, result.reported, result.nowhere,
              result.impure[0], result.impure[1], result.impure[2], result.peer.wrong, result.peer.swapped, result.peer.renamed);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  CLI::App app("How often a marker of a body bears a wrong name, beside a plain tracker");
  Plan plan;
  add_options(app, plan);
  CLI11_PARSE(app, count, words);
  plan.room.frames = static_cast<std::int64_t>(plan.duration_s * plan.room.rate_hz);
  print_heading(plan);
  for (std::uint64_t seed = plan.first_seed; seed < plan.first_seed + static_cast<std::uint64_t>(plan.seeds); ++seed) {
    plan.room.seed = seed;
    print(seed, assess(plan.room, plan.live, plan.events));
  }
  return 0;
}

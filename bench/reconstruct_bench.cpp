// From blobs to labelled markers in space, step by step and as a whole, and how each grows with cameras and markers. One core.
// Peers and bounds: cv::triangulatePoints beside our triangulation of the same two rays; liboptv needs 2.5 ms for the
// correspondence of 4 cameras and 200 markers, 9.0 ms for 500. Counters state how right the answers are.
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <vector>

#include <benchmark/benchmark.h>
#include <opencv2/calib3d.hpp>

#include "marey/pipeline/markers/reconstruct.h"
#include "marey/reconstruct/correspond.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room.h"
#include "marey/track/roster/roster_tracker.h"

namespace {

using namespace marey;

/// Frames of a room, as a corresponder is given them, and whose every blob is.
struct Recording {
  std::vector<Camera> cameras;
  std::vector<std::vector<Observation<2>>> detected;
  std::vector<std::vector<int>> owner;
  int markers = 0;
};

Recording record(const simulate::room::RoomOptions& options) {
  const simulate::room::RoomScene scene(options);
  Recording recording;
  recording.markers = options.markers;
  for (const RigCamera& camera : scene.rig().cameras) recording.cameras.push_back(*camera.camera());
  for (std::int64_t i = 0; i < options.frames; ++i) {
    auto& detected = recording.detected.emplace_back();
    auto& owner = recording.owner.emplace_back();
    const simulate::room::RoomFrame frame = scene.frame(i);
    for (int c = 0; c < std::ssize(frame.detected); ++c) {
      for (const simulate::room::RoomBlob& blob : frame.detected[static_cast<std::size_t>(c)]) {
        Observation<2> one;
        one.value = blob.pixel;
        one.covariance.reset();
        one.camera = CameraId{c};
        detected.push_back(one);
        owner.push_back(blob.marker.value_or(-1));
      }
    }
  }
  return recording;
}

simulate::room::RoomOptions cloud(int cameras, int markers, double dropped, double ghosts, int frames = 40) {
  simulate::room::RoomOptions options;
  options.motion = simulate::room::RoomMotion::cloud;
  options.cameras = cameras;
  options.markers = markers;
  options.dropped = dropped;
  options.ghosts = ghosts;
  options.frames = frames;
  return options;
}

/// Cameras see one point: a ray of each.
std::vector<reconstruct::SightLine> rays_of(const std::vector<Camera>& cameras, simulate::Random& random, double sigma) {
  const Vector<3> point(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.3, 2));
  std::vector<reconstruct::SightLine> rays;
  for (int c = 0; c < std::ssize(cameras); ++c) {
    const auto pixel = cameras[static_cast<std::size_t>(c)].project(point);
    if (!pixel) continue;
    const Vector<2> noisy = *pixel + Vector<2>(random.gaussian(0, sigma), random.gaussian(0, sigma));
    if (const auto ray = reconstruct::sight_line(cameras[static_cast<std::size_t>(c)], c, noisy, sigma)) rays.push_back(*ray);
  }
  return rays;
}

void triangulation(benchmark::State& state) {
  simulate::Random random(1);
  const Recording recording = record(cloud(static_cast<int>(state.range(0)), 1, 0, 0, 1));
  std::vector<std::vector<reconstruct::SightLine>> points;
  for (int i = 0; i < 500; ++i) points.push_back(rays_of(recording.cameras, random, 0.1));
  const reconstruct::Triangulator triangulator;
  for (auto _ : state) {
    for (const auto& rays : points) benchmark::DoNotOptimize(triangulator(rays));
  }
  state.counters["ns_a_point"] =
      benchmark::Counter(500, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(triangulation)->Arg(2)->Arg(4)->Arg(8)->Arg(32);

/// OpenCV's linear triangulation of two views, 500 points at a time: no iteration, no noise model, no covariance.
void triangulation_opencv(benchmark::State& state) {
  simulate::Random random(1);
  const cv::Matx34d left(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0), right(1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 1, 0);
  cv::Mat a(2, 500, CV_64F), b(2, 500, CV_64F), homogeneous;
  for (int i = 0; i < 500; ++i) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(2, 5);
    a.at<double>(0, i) = x / z, a.at<double>(1, i) = y / z;
    b.at<double>(0, i) = (x - 1) / z, b.at<double>(1, i) = y / z;
  }
  for (auto _ : state) cv::triangulatePoints(left, right, a, b, homogeneous);
  state.counters["ns_a_point"] =
      benchmark::Counter(500, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}
BENCHMARK(triangulation_opencv);

/// Cameras, markers, per cent of blobs dropped, per cent of ghosts; no history.
void correspondence(benchmark::State& state) {
  const Recording recording = record(cloud(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)),
                                           static_cast<double>(state.range(2)) / 100, static_cast<double>(state.range(3)) / 100));
  reconstruct::Corresponder corresponder(recording.cameras);
  double groups = 0, pure = 0, found = 0, to_find = 0;
  for (std::size_t i = 0; i < recording.detected.size(); ++i) {
    std::map<int, int> views;
    for (const int owner : recording.owner[i]) ++views[owner];
    std::set<int> right;
    for (const reconstruct::Located& located : corresponder.match(recording.detected[i]).points) {
      const int owner = recording.owner[i][static_cast<std::size_t>(located.detected.front())];
      bool same = owner >= 0;
      for (const int s : located.detected) same &= recording.owner[i][static_cast<std::size_t>(s)] == owner;
      ++groups;
      pure += same;
      if (same) right.insert(owner);
    }
    for (const auto& [owner, count] : views) {
      if (owner < 0 || count < 3) continue;
      ++to_find;
      found += right.contains(owner);
    }
  }
  std::size_t next = 0;
  for (auto _ : state)
    benchmark::DoNotOptimize(corresponder.match(recording.detected[next++ % recording.detected.size()]).points.size());
  state.counters["pure_%"] = 100 * pure / groups;
  state.counters["found_%"] = 100 * found / to_find;
}
BENCHMARK(correspondence)
    ->Unit(benchmark::kMillisecond)
    ->Args({4, 200, 20, 10})
    ->Args({4, 500, 0, 0})
    ->Args({4, 50, 20, 10})
    ->Args({8, 200, 20, 10})
    ->Args({32, 200, 5, 5});

/// Blobs to followed markers, one frame: prediction, correspondence, triangulation, tracking. Cameras, markers.
void chain(benchmark::State& state) {
  simulate::room::RoomOptions options = cloud(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), 0.05, 0.05, 400);
  const Recording recording = record(options);
  reconstruct::Corresponder corresponder(recording.cameras);
  const auto tracker = track::roster::make_roster_tracker<3>(pipeline::markers::space_tracker_options());
  std::vector<Observation<3>> points;
  std::int64_t frame = 0;
  std::size_t next = 0;
  bool forward = true;  // there and back, so that the markers never jump
  for (auto _ : state) {
    const Timestamp now = timestamp_from_seconds(static_cast<double>(frame++) / options.rate_hz);
    const auto& found = corresponder.match(recording.detected[next], tracker->expected(now));
    points.clear();
    for (const reconstruct::Located& located : found.points) {
      Observation<3> point;
      point.value = located.point.position;
      point.covariance = located.point.covariance;
      points.push_back(point);
    }
    benchmark::DoNotOptimize(tracker->step(now, points).data());
    if (forward ? next + 1 == recording.detected.size() : next == 0) forward = !forward;
    forward ? ++next : --next;
  }
}
BENCHMARK(chain)->Unit(benchmark::kMillisecond)->Args({4, 50})->Args({8, 50})->Args({16, 50})->Args({8, 200})->Args({32, 200});

/// The tracker alone, on true places with noise.
void tracking(benchmark::State& state) {
  const int markers = static_cast<int>(state.range(0));
  simulate::room::RoomOptions options = cloud(2, markers, 0, 0, 1);
  const simulate::room::RoomScene scene(options);
  const auto tracker = track::roster::make_roster_tracker<3>(pipeline::markers::space_tracker_options());
  std::vector<std::vector<Observation<3>>> frames;
  simulate::Random random(1);
  for (int i = 0; i < 300; ++i) {
    auto& points = frames.emplace_back();
    for (const Vector<3>& location : scene.points(i / options.rate_hz)) {
      Observation<3> point;
      point.value = location + Vector<3>(random.gaussian(0, 3e-4), random.gaussian(0, 3e-4), random.gaussian(0, 3e-4));
      point.covariance = Matrix<3>::Identity() * 9e-8;
      points.push_back(point);
    }
  }
  std::int64_t frame = 0;
  for (auto _ : state) {
    const std::int64_t turn = frame % 598;
    const auto& points = frames[static_cast<std::size_t>(turn < 300 ? turn : 598 - turn)];
    benchmark::DoNotOptimize(tracker->step(timestamp_from_seconds(static_cast<double>(frame++) / options.rate_hz), points).data());
  }
}
BENCHMARK(tracking)->Unit(benchmark::kMillisecond)->Arg(10)->Arg(50)->Arg(200);

}  // namespace

// How well a PTZ camera is followed: simulated matches (an operator's motion, blur, people, a scoreboard), clicks as a user
// would make them, the exact camera of every frame. Beside it a naive peer on the same images: homographies chained from frame to
// frame (corners, Lucas-Kanade, RANSAC), begun at the exact first one.
//
//   turning_camera [--seeds N] [--frames N] [--scene NAME] [--times]     scenes: plain, cut, graphics, blur
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>

#include "marey/calibrate/ptz/ptz_tracker.h"
#include "marey/geometry/ground_view.h"
#include "marey/simulate/match/ptz_match.h"

#include "experiments/markdown_table.h"

namespace {

using namespace marey;
using namespace marey::calibrate::ptz;
using simulate::match::PtzMatch;
using simulate::match::PtzMatchOptions;

constexpr double kDegrees = 180 / M_PI;

double cpu_seconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

struct Sorted {
  std::vector<double> values;
  double at(double fraction) {
    if (values.empty()) return -1;
    std::sort(values.begin(), values.end());
    return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
  }
};

struct Score {
  Sorted pan, tilt, focal, ground, peer, jitter;
  double nees = 0;
  int known = 0, lost = 0, wrong = 0;
  double track_s = 0;
  int frames = 0;
};

/// Places of the image that show the pitch, and where a view puts them.
void compare(const GroundView& truth, const GroundView& found, cv::Size size, Sorted& off) {
  for (double x = 0.08; x < 1; x += 0.14) {
    for (double y = 0.3; y < 1; y += 0.22) {
      const Vector<2> pixel(x * size.width, y * size.height);
      const auto a = truth.location(pixel), b = found.location(pixel);
      if (!a || a->ground.x() < 0 || a->ground.y() < 0 || a->ground.x() > 105 || a->ground.y() > 68) continue;
      off.values.push_back(b ? (a->ground - b->ground).norm() : 100);
    }
  }
}

/// Homographies chained from frame to frame.
class ChainedHomographies {
 public:
  explicit ChainedHomographies(const GroundView& first, cv::Size size) : size_(size) {
    std::vector<cv::Point2f> pixels, locations;
    for (double x = 0.1; x < 1; x += 0.2) {
      for (double y = 0.45; y < 1; y += 0.15) {
        const auto location = first.location({x * size.width, y * size.height});
        if (!location) continue;
        pixels.emplace_back(static_cast<float>(x * size.width), static_cast<float>(y * size.height));
        locations.emplace_back(static_cast<float>(location->ground.x()), static_cast<float>(location->ground.y()));
      }
    }
    ground_from_image_ = cv::findHomography(pixels, locations);
  }

  void step(const cv::Mat& luma) {
    if (!last_.empty()) {
      std::vector<cv::Point2f> before, after;
      cv::goodFeaturesToTrack(last_, before, 400, 0.01, 10);
      std::vector<unsigned char> found;
      std::vector<float> error;
      cv::calcOpticalFlowPyrLK(last_, luma, before, after, found, error);
      std::vector<cv::Point2f> from, to;
      for (std::size_t i = 0; i < before.size(); ++i) {
        if (found[i]) from.push_back(after[i]), to.push_back(before[i]);
      }
      const cv::Mat step = from.size() >= 8 ? cv::findHomography(from, to, cv::RANSAC, 2) : cv::Mat();
      if (!step.empty()) ground_from_image_ = ground_from_image_ * step;
    }
    last_ = luma.clone();
  }

  std::optional<GroundView> view() const {
    Matrix<3> H;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) H(i, k) = ground_from_image_.at<double>(i, k);
    }
    if (!H.allFinite() || std::abs(H.determinant()) < 1e-14) return std::nullopt;
    return GroundView(H, size_);
  }

 private:
  cv::Size size_;
  cv::Mat last_, ground_from_image_;
};

PtzMatchOptions scene_of(const std::string& name) {
  PtzMatchOptions options;
  if (name == "cut") options.cuts = {{0.4, 1.2}, {4, 5}};
  if (name == "graphics") options.graphics = {{2, 5}};
  if (name == "blur") options.exposure = 0.02, options.noise = 3;
  return options;
}

std::vector<ClickedFrame> clicks_of(const PtzMatchOptions& options, std::uint64_t seed, int frames) {
  PtzMatch match(options, seed);
  std::vector<ClickedFrame> clicks;
  std::vector<double> pans;
  for (int i = 0; i < frames && clicks.size() < 4; ++i) {
    match.advance();
    const auto heading = match.heading();
    if (!heading || std::any_of(pans.begin(), pans.end(), [&](double pan) { return std::abs(pan - heading->pan) < 0.12; }))
      continue;
    const auto found = match.clicks(1.5);
    if (found.size() < 4) continue;
    pans.push_back(heading->pan);
    ClickedFrame frame{i, {}};
    for (const auto& click : found) frame.locations.push_back({click.ground, click.pixel, ""});
    clicks.push_back(std::move(frame));
  }
  return clicks;
}

/// Pan and tilt of the optical axis in the world, whatever share of them is the tripod's lean.
Vector<2> axis_of(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size) {
  const Vector<3> ahead = geometry::camera_of(tripod, heading, size).camera_from_world().rotation.row(2);
  return {std::atan2(ahead.x(), ahead.y()), std::asin(-ahead.z())};
}

/// The result for each frame beside the truth: where the axis points, how long the lens is, where places of the pitch are seen.
void assess(const PtzResult& result, const geometry::Tripod& tripod, const std::vector<std::optional<geometry::Heading>>& truth,
            const std::vector<GroundView>& views, cv::Size size, Score& score) {
  score.frames += static_cast<int>(truth.size());
  Vector<2> last_off = Vector<2>::Zero(), last_true = Vector<2>::Zero();
  bool goes_on = false;  // from the frame before
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const PtzCamera::Turn& turn = result.camera.rotations[i];
    if (!truth[i]) {
      score.wrong += turn.heading ? 1 : 0;
      goes_on = false;
      continue;
    }
    ++score.known;
    if (!turn.heading) {
      ++score.lost;
      goes_on = false;
      continue;
    }
    const Vector<2> is = axis_of(tripod, *truth[i], size), found = axis_of(result.camera.tripod, *turn.heading, size),
                    off = found - is;
    score.pan.values.push_back(std::abs(off.x()) * kDegrees);
    score.tilt.values.push_back(std::abs(off.y()) * kDegrees);
    const double focal = turn.heading->log_focal - truth[i]->log_focal;
    score.focal.values.push_back(100 * std::abs(focal));
    compare(views[i], GroundView(geometry::camera_of(result.camera.tripod, *turn.heading, size)), size, score.ground);
    const double px = std::exp(truth[i]->log_focal) * size.width / 2;
    if (goes_on && (is - last_true).norm() * px < 1) score.jitter.values.push_back(px * (off - last_off).norm());
    last_off = off, last_true = is, goes_on = true;
    const Vector<3> error(off.x(), off.y(), focal);
    score.nees += error.dot(turn.covariance.inverse() * error) / 3;
  }
}

void run(const std::string& scene, std::uint64_t seed, int frames, Score& score) {
  const PtzMatchOptions options = scene_of(scene);
  const std::vector<ClickedFrame> clicks = clicks_of(options, seed, frames);
  if (clicks.size() < 2) {
    std::fprintf(stderr, "seed %llu: the camera looks to one side only; omitted\n", static_cast<unsigned long long>(seed));
    return;
  }
  const ClickedTripod clicked = tripod_from_clicks(clicks, options.size, options.pitch);
  PtzMatch match(options, seed);
  PtzTracker tracker(clicked.tripod, options.size);
  for (std::size_t i = 0; i < clicks.size(); ++i) tracker.know(clicks[i].frame, clicked.headings[i], clicks[i].locations);
  std::vector<std::optional<geometry::Heading>> truth;
  std::vector<GroundView> views;
  std::optional<ChainedHomographies> peer;
  for (int i = 0; i < frames; ++i) {
    match.advance();
    const Image image = match.image();
    truth.push_back(match.heading());
    views.emplace_back(match.camera());
    const double begin = cpu_seconds();
    tracker.add(image, match.time());
    score.track_s += cpu_seconds() - begin;
    if (!peer) peer.emplace(views.front(), options.size);
    peer->step(image.luma());
    if (const auto view = peer->view(); truth.back() && view && i % 5 == 0) compare(views.back(), *view, options.size, score.peer);
  }
  const double begin = cpu_seconds();
  const PtzResult result = tracker.finish();
  score.track_s += cpu_seconds() - begin;
  assess(result, match.tripod(), truth, views, options.size, score);
}

void print_score(const std::string& scene, Score& score, bool times) {
  const auto both = [](Sorted& of, int digits) { return fmt::format("{:.{}f}, {:.{}f}", of.at(.5), digits, of.at(.95), digits); };
  std::vector<std::string> cells{scene,
                                 both(score.pan, 4),
                                 both(score.tilt, 4),
                                 both(score.focal, 3),
                                 both(score.ground, 3),
                                 fmt::format("{:.1f}", 100.0 * score.lost / std::max(1, score.known)),
                                 std::to_string(score.wrong),
                                 fmt::format("{:.2f}", score.jitter.at(.95)),
                                 fmt::format("{:.1f}", score.nees / std::max(1, score.known - score.lost)),
                                 both(score.peer, 2)};
  if (times) cells.push_back(fmt::format("{:.1f}", 1000 * score.track_s / std::max(1, score.frames)));
  std::printf("%s", marey::experiments::markdown_row(cells).c_str());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  int seeds = 3, frames = 250;
  std::string only;
  bool times = false;
  CLI::App app("A camera that pans, tilts and zooms over a simulated match, of 1280 x 720 at 25 Hz");
  app.add_option("--seeds", seeds, "from 1 on")->capture_default_str();
  app.add_option("--frames", frames)->capture_default_str();
  app.add_option("--scene", only, "plain, cut, graphics or blur; all without it");
  app.add_flag("--times", times, "processor time of a frame too");
  CLI11_PARSE(app, count, words);
  std::vector<std::string> titles{"scene", "pan, °",         "tilt, °", "focal length, %",   "places, m", "lost, %",
                                  "wrong", "jitter p95, px", "NEES",    "chained: places, m"};
  if (times) titles.emplace_back("processor, ms a frame");
  std::printf("%s", experiments::markdown_header(titles).c_str());
  for (const std::string scene : {"plain", "cut", "graphics", "blur"}) {
    if (!only.empty() && scene != only) continue;
    Score score;
    for (int seed = 1; seed <= seeds; ++seed) run(scene, static_cast<std::uint64_t>(seed), frames, score);
    print_score(scene, score, times);
  }
}

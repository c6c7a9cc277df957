// How well `marey calibrate ptz` does on clips that `marey simulate ptz` wrote: a row a clip, and one over all of them.
//
//   ptz_clips FOLDER... [--no-clicks] [--set NAME=VALUE]...
//
// A frame is wrong where the middle of the errors of its places is above 1 m, and "not said" where that is also more than three
// times what its own covariance promises; a frame of another camera that was taken for the pitch is both.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/LU>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_ptz.h"
#include "marey/geometry/ground_view.h"
#include "marey/pipeline/calibrate/calibrate_ptz.h"
#include "marey/pipeline/people/ground/ptz_views.h"

#include "experiments/markdown_table.h"

namespace {

using namespace marey;
using pipeline::calibrate::PtzRun;
using pipeline::calibrate::PtzRunOptions;

constexpr double kWrong = 1;     // m
constexpr double kPromise = 3;   // standard deviations
constexpr int kSaturated = 100;  // m: a place that is not seen at all is off by as much

struct Score {
  std::vector<double> off, median_off;  // m
  double axis_square = 0, position_square = 0;
  int axes = 0, positions = 0;
  int frames = 0, lost = 0, wrong = 0, unreported = 0, failed = 0;
  double seconds = 0;

  void add(const Score& other) {
    off.insert(off.end(), other.off.begin(), other.off.end());
    median_off.insert(median_off.end(), other.median_off.begin(), other.median_off.end());
    axis_square += other.axis_square, position_square += other.position_square, axes += other.axes, positions += other.positions;
    frames += other.frames, lost += other.lost, wrong += other.wrong, unreported += other.unreported, failed += other.failed;
    seconds += other.seconds;
  }
};

double at(std::vector<double> values, double fraction) {
  if (values.empty()) return -1;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

/// Pan and tilt of the optical axis in the world, whatever share of them is the tripod's lean.
Vector<2> axis_of(const geometry::Tripod& tripod, const geometry::Heading& heading, cv::Size size) {
  const Vector<3> ahead = geometry::camera_of(tripod, heading, size).camera_from_world().rotation.row(2);
  return {std::atan2(ahead.x(), ahead.y()), std::asin(-ahead.z())};
}

struct FrameOff {
  std::vector<double> metres;
  double in_deviations = 0;  // mean square, of two degrees of freedom each
};

FrameOff frame_off(const PtzCamera& truth, const PtzCamera& found, std::size_t frame, const RigCamera& camera) {
  FrameOff result;
  const cv::Size size = *camera.size;
  const GroundView is(geometry::camera_of(truth.tripod, *truth.rotations[frame].heading, size)),
      was(geometry::camera_of(found.tripod, *found.rotations[frame].heading, size));
  const Timestamp time = timestamp_from_seconds(found.rotations[frame].time_s);
  for (double x = 0.08; x < 1; x += 0.14) {
    for (double y = 0.3; y < 1; y += 0.22) {
      const Vector<2> pixel(x * size.width, y * size.height);
      const auto a = is.location(pixel), b = was.location(pixel);
      if (!a || a->ground.x() < 0 || a->ground.y() < 0 || a->ground.x() > 105 || a->ground.y() > 68) continue;
      const Vector<2> off = b ? Vector<2>(b->ground - a->ground) : Vector<2>(kSaturated, 0);
      result.metres.push_back(std::min<double>(kSaturated, off.norm()));
      const Matrix<2> covariance =
          pipeline::people::ground::aim_covariance(camera, found, time, pixel) + 1e-8 * Matrix<2>::Identity();
      result.in_deviations += off.dot(covariance.inverse() * off) / 2;
    }
  }
  if (!result.metres.empty()) result.in_deviations /= static_cast<double>(result.metres.size());
  return result;
}

Score assessed(const PtzCamera& truth, const PtzRun& run) {
  Score score;
  const RigCamera& camera = run.rig.cameras.front();
  for (std::size_t i = 0; i < truth.rotations.size(); ++i) {
    ++score.frames;
    const bool known = i < run.result.camera.rotations.size() && run.result.camera.rotations[i].heading;
    if (!truth.rotations[i].heading) {
      score.wrong += known ? 1 : 0, score.unreported += known ? 1 : 0;
      continue;
    }
    if (!known) {
      ++score.lost;
      continue;
    }
    const PtzCamera::Turn& turn = run.result.camera.rotations[i];
    const FrameOff off = frame_off(truth, run.result.camera, i, camera);
    if (off.metres.empty()) continue;
    const double middle = at(off.metres, 0.5);
    score.off.insert(score.off.end(), off.metres.begin(), off.metres.end());
    score.wrong += middle > kWrong ? 1 : 0;
    score.unreported += middle > kWrong && off.in_deviations > kPromise * kPromise ? 1 : 0;
    score.position_square += std::min(off.in_deviations, 1e6), ++score.positions;
    Vector<3> error;
    error << axis_of(run.result.camera.tripod, *turn.heading, *camera.size) -
                 axis_of(truth.tripod, *truth.rotations[i].heading, *camera.size),
        turn.heading->log_focal - truth.rotations[i].heading->log_focal;
    score.axis_square += std::min(1e6, error.dot(turn.covariance.inverse() * error) / 3), ++score.axes;
  }
  return score;
}

void print_row(const std::string& name, const Score& score) {
  const auto percent = [&](int part) { return fmt::format("{:.1f}", 100.0 * part / std::max(1, score.frames)); };
  std::printf("%s",
              experiments::markdown_row({name, percent(score.lost), percent(score.wrong), percent(score.unreported),
                                         fmt::format("{:.3f}, {:.3f}", at(score.off, 0.5), at(score.off, 0.95)),
                                         fmt::format("{:.2f}", std::sqrt(score.axis_square / std::max(1, score.axes))),
                                         fmt::format("{:.2f}", std::sqrt(score.position_square / std::max(1, score.positions))),
                                         fmt::format("{:.0f}", score.frames / std::max(1e-9, score.seconds))})
                  .c_str());
  std::fflush(stdout);
}

/// Constants that a sweep may change.
void set(PtzRunOptions& options, const std::string& text) {
  auto& t = options.tracking;
  const std::map<std::string, std::function<void(double)>> all{
      {"flow_px", [&](double v) { t.flow_px = v; }},
      {"flow_zoom", [&](double v) { t.flow_zoom = v; }},
      {"moving_fraction", [&](double v) { t.moving_fraction = v; }},
      {"moving_zoom", [&](double v) { t.moving_zoom = v; }},
      {"unsure_px", [&](double v) { t.unsure_px = v; }},
      {"fraction", [&](double v) { t.fraction = v; }},
      {"patience", [&](double v) { t.patience = static_cast<int>(v); }},
      {"search_interval", [&](double v) { t.search_interval = static_cast<int>(v); }},
      {"per_line", [&](double v) { t.aim.per_line = v, t.tripod.per_line = v; }},
      {"again_fraction", [&](double v) { t.again.fraction = v; }},
      {"again_rival", [&](double v) { t.again.rival = v; }},
  };
  const auto equals = text.find('=');
  const auto found = all.find(text.substr(0, equals));
  if (found == all.end() || equals == std::string::npos) throw Error("--set {}: no such constant", text);
  found->second(std::stod(text.substr(equals + 1)));
}

Score run_clip(const std::filesystem::path& folder, const PtzRunOptions& options, bool clicks) {
  const auto truth = format::rig::read_ptz((folder / "rig.toml").string());
  const std::clock_t begin = std::clock();
  try {
    const PtzRun run =
        pipeline::calibrate::calibrate_ptz((folder / "main.mp4").string(), clicks ? (folder / "clicks.csv").string() : "", options);
    const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    Score score = assessed(*truth.front(), run);
    score.seconds = seconds;
    return score;
  } catch (const Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    Score score;
    score.frames = score.lost = static_cast<int>(truth.front()->rotations.size());
    score.failed = 1;
    return score;
  }
}

}  // namespace

int main(int count, char** words) {
  std::vector<std::string> folders, settings;
  bool no_clicks = false;
  CLI::App app("Simulated clips of a PTZ camera, calibrated by their clicks and compared with their truth");
  app.add_option("folders", folders, "as marey simulate ptz writes them")->required();
  app.add_option("--set", settings, "a constant, NAME=VALUE");
  app.add_flag("--no-clicks", no_clicks, "by the lines of the images alone");
  CLI11_PARSE(app, count, words);
  PtzRunOptions options;
  for (const std::string& one : settings) set(options, one);
  std::printf("%s", experiments::markdown_header({"clip", "lost, %", "wrong by > 1 m, %", "and not said, %", "places p50, p95, m",
                                                  "view error ÷ sd", "place error ÷ sd", "frames a processor second"})
                        .c_str());
  Score all;
  for (const std::string& folder : folders) {
    const Score score = run_clip(folder, options, !no_clicks);
    print_row(std::filesystem::path(folder).filename().string(), score);
    all.add(score);
  }
  print_row("all", all);
  std::printf("refused: %d of %zu\n", all.failed, folders.size());
}

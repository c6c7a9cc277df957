#include "marey/pipeline/calibrate_wand.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <unistd.h>

#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/live_blobs.h"

#include "blob_options.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "live_screen.h"
#include "rig_inputs.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibrateWand {
  RigInputs inputs;
  std::string wand, distance, out;
  pipeline::CalibrateWandOptions options;
  bool json = false;
  bool quiet = false;
};

calibrate::wand::WandShape wand_of(const std::string& text) {
  calibrate::wand::WandShape wand;
  if (text == "led") return wand;
  wand.distances = numbers_in(text, ',', closed(-100, 100), "the markers' distances from the first in m, as 0,0.12,0.30, or led");
  if (wand.distances.size() >= 2) return wand;
  throw WrongUsage("{}: a wand has two or three markers; a single light is \"led\"", text);
}

std::optional<calibrate::wand::KnownDistance> distance_of(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto comma = text.find(','), equal = text.find('=');
  if (comma == std::string::npos || equal == std::string::npos || equal < comma) {
    throw WrongUsage("{}: write CAM1,CAM2=METRES, two cameras' names and how far they stand apart", text);
  }
  const double metres = number_in(text.substr(equal + 1), "m", above(0, 1e5));
  return calibrate::wand::KnownDistance{text.substr(0, comma), text.substr(comma + 1, equal - comma - 1), metres};
}

Json as_json(const calibrate::FitQuality& fit) {
  return {{"mean_px", fit.mean_px}, {"rms_px", fit.rms_px}, {"inliers", fit.inliers}, {"observations", fit.observations}};
}

Json as_json(const calibrate::wand::WandResult& result) {
  const calibrate::RigReport& report = result.report;
  Json json = {{"all", as_json(report.all)}, {"cameras", Json::object()}};
  json["all"]["noise_px"] = report.noise_px;
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const calibrate::CameraReport& camera = report.cameras[c];
    Json& entry = json["cameras"][camera.name] = as_json(camera.fit);
    entry["coverage"] = camera.coverage;
    entry["world_error_mm"] = camera.world_error_mm;
    entry["offset_s"] = result.rig.cameras[c].offset_s.value_or(0);
    entry["deviation"] = {{"centre_mm", 1000 * camera.deviation.centre.norm()},
                          {"rotation_rad", camera.deviation.rotation.norm()},
                          {"focal", camera.deviation.focal}};
  }
  json["volume"] = {{"median_mm", report.volume.median_mm},
                    {"worst_tenth_mm", report.volume.worst_tenth_mm},
                    {"seen_by_two", report.volume.seen_by_two},
                    {"seen_by_three", report.volume.seen_by_three}};
  if (report.held_out) {
    json["held_out"] = as_json(report.held_out->fit);
    json["held_out"]["frames"] = report.held_out->frames;
    json["held_out"]["noise_px"] = report.held_out->noise_px;
    json["held_out"]["length_mean_mm"] = report.held_out->length_mean_mm;
    json["held_out"]["length_rms_mm"] = report.held_out->length_rms_mm;
  }
  json["grade"] = report.grade;
  json["meaning"] = report.meaning;
  json["notes"] = result.notes;
  return json;
}

void print_table(const calibrate::wand::WandResult& result) {
  const calibrate::RigReport& report = result.report;
  fmt::print("{:<16} {:>8} {:>8} {:>9} {:>9} {:>9} {:>10} {:>10}\n", "camera", "mean px", "rms px", "inliers", "of", "coverage",
             "error mm", "offset ms");
  const auto row = [](const std::string& name, const calibrate::FitQuality& fit) {
    fmt::print("{:<16} {:>8.3f} {:>8.3f} {:>9} {:>9}", name, fit.mean_px, fit.rms_px, fit.inliers, fit.observations);
  };
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const calibrate::CameraReport& camera = report.cameras[c];
    row(camera.name, camera.fit);
    fmt::print(" {:>7.0f} % {:>10.3f} {:>10.3f}\n", 100 * camera.coverage, camera.world_error_mm,
               1000 * result.rig.cameras[c].offset_s.value_or(0));
  }
  row("all", report.all);
  fmt::print("\n");
  if (report.held_out) {
    fmt::print("held out: {} places of the wand, {:.3f} px rms; its length {:+.2f} mm in the mean, {:.2f} mm rms\n",
               report.held_out->frames, report.held_out->fit.rms_px, report.held_out->length_mean_mm,
               report.held_out->length_rms_mm);
  }
  fmt::print("volume: a marker's place is known to {:.2f} mm (median), {:.2f} mm (worst tenth); three cameras see {:.0f} % of it\n",
             report.volume.median_mm, report.volume.worst_tenth_mm, 100 * report.volume.seen_by_three);
  fmt::print("grade: {} ({})\n", report.grade, report.meaning);
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
}

/// What is said while the wand is waved before live cameras: a line that is written over on a terminal, elsewhere a sentence for
/// each camera that has seen enough.
class WandScreen {
 public:
  explicit WandScreen(bool quiet) : quiet_(quiet), terminal_(isatty(STDERR_FILENO) != 0) {}
  ~WandScreen() {
    if (shown_) fmt::print(stderr, "\r\x1b[K");
  }
  WandScreen(const WandScreen&) = delete;
  WandScreen& operator=(const WandScreen&) = delete;

  void begun(bool keys) { say(fmt::format("wave the wand through the whole volume{}", keys ? "; q: that will do" : "")); }

  void show(const pipeline::WandSeen& seen) {
    covered_.resize(seen.cameras.size());
    for (std::size_t c = 0; c < seen.cameras.size(); ++c) {
      if (!seen.cameras[c].covered || covered_[c]) continue;
      covered_[c] = true;
      say(fmt::format("camera \"{}\" has seen enough: {:.0f} % of its picture", seen.cameras[c].name,
                      100 * seen.cameras[c].coverage));
    }
    if (seen.enough) say(fmt::format("all of them have, after {:.0f} s", seen.seconds));
    if (quiet_ || !terminal_) return;
    std::string line = fmt::format("{:.0f} s ", seen.seconds);
    for (const pipeline::WandSeen::Camera& camera : seen.cameras) {
      line += camera.state == FeedState::live || camera.state == FeedState::back
                  ? fmt::format(" {} {:.0f} %", camera.name, 100 * camera.coverage)
                  : fmt::format(" {} {}", camera.name, to_string(camera.state));
    }
    fmt::print(stderr, "\r\x1b[K{}", line.substr(0, static_cast<std::size_t>(std::max(20, terminal_columns() - 1))));
    std::fflush(stderr);
    shown_ = true;
  }

 private:
  void say(const std::string& sentence) {
    if (quiet_) return;
    fmt::print(stderr, "{}{}\n", shown_ ? "\r\x1b[K" : "", sentence);
    shown_ = false;
  }

  bool quiet_, terminal_, shown_ = false;
  std::vector<bool> covered_;
};

void run(const CalibrateWand& command) {
  pipeline::CalibrateWandOptions options = command.options;
  options.observations = observations_of(command.inputs);
  options.wand = wand_of(command.wand);
  options.how.distance = distance_of(command.distance);
  const Rig rig = rig_of(command.inputs);
  const bool live = options.observations.empty() && pipeline::has_live_cameras(rig);
  std::atomic<bool> will_do = false;
  std::optional<WandScreen> screen;
  std::optional<Keys> keys;
  if (live) {
    screen.emplace(command.quiet);
    keys.emplace([&](char key) { will_do = will_do || key == 'q'; });
    screen->begun(keys->listens());
    options.waving = [&](const pipeline::WandSeen& seen) {
      screen->show(seen);
      return !will_do;
    };
  }
  const pipeline::WandCalibration result =
      with_progress(command.quiet || live, [&](const Hooks& hooks) { return pipeline::calibrate_wand(rig, options, hooks); });
  keys.reset();
  screen.reset();
  warn(result.warnings);
  format::rig::write_rig(result.found.rig, command.out);
  if (command.json) {
    print(as_json(result.found));
  } else if (!command.quiet) {
    print_table(result.found);
    fmt::print("rig: {}\n", command.out);
  }
}

}  // namespace

void add_calibrate_wand(Command& calibrate) {
  auto options = std::make_shared<CalibrateWand>();
  using calibrate::wand::LensUse;
  constexpr std::array<std::pair<const char*, LensUse>, 3> kLensUses{
      {{"auto", LensUse::automatic}, {"fixed", LensUse::fixed}, {"refined", LensUse::refined}}};
  Command command = calibrate.subcommand("wand", "Where the cameras stand, from a wand or a light waved before them");
  Option rig = add_rig_inputs(command, options->inputs);
  command.text("--wand", options->wand, "the markers' distances from the first, m, as 0,0.12,0.30; or led: a single light")
      .required()
      .check([](const std::string& text) { wand_of(text); });
  command.text("--distance", options->distance, "CAM1,CAM2=METRES: how far two cameras stand apart, for a single light's scale")
      .check([](const std::string& text) { distance_of(text); });
  command.output_file("-o,--output", options->out, "the rig file that is written").required().ends_in({".toml"}).may_replace(rig);
  command.choice("--lens", options->options.how.lens, kLensUses,
                 "refined where that explains more, and estimated where not given (auto); kept; refined");
  command.flag("--synced", options->options.synced, "the cameras' clocks are right: look for no time offsets");
  command.seed(options->options.how.seed, "of the random draws");
  command.number("--for", options->options.wave_s, "s", closed(1, 36'000),
                 "live cameras: the wand is waved until all have seen enough of it, at most so long");
  add_threshold(command, options->options.markers.threshold);
  command.flag("--dark", options->options.markers.dark, "markers are darker than what is around them");
  command.reports(options->json, options->quiet, "table");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

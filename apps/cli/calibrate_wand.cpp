#include "marey/pipeline/calibrate/calibrate_wand.h"

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/calibrate/wand/wand_coverage.h"
#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/calibrate/live_blobs.h"
#include "marey/pipeline/jobs/detection_rows.h"

#include "calibration_page.h"
#include "camera_distance.h"
#include "command_line.h"
#include "commands.h"
#include "ground_frame.h"
#include "json_value.h"
#include "live_screen.h"
#include "rig_inputs.h"
#include "run_hooks.h"
#include "view_options.h"

namespace marey::cli {
namespace {

struct CalibrateWand {
  RigInputs inputs;
  std::string wand, distance, out;
  std::string frame = kDefaultGroundFrame;
  pipeline::calibrate::CalibrateWandOptions options;
  bool view = false, allow_control = false;
  viewer::ListenAddress web;
  bool json = false;
  bool quiet = false;
};

calibrate::MarkerLine wand_of(const std::string& text) {
  calibrate::MarkerLine wand;
  if (text == "led") return wand;
  wand.distances = numbers_in(text, ',', closed(-100, 100), "the markers' distances from the first in m, as 0,0.12,0.30, or led");
  if (wand.distances.size() >= 2) return wand;
  throw WrongUsage("{}: a wand has two or three markers; a single light is \"led\"", text);
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
                    {"p90_mm", report.volume.worst_tenth_mm},
                    {"two_view", report.volume.observed_by_two},
                    {"three_view", report.volume.observed_by_three}};
  if (report.held_out) {
    json["held_out"] = as_json(report.held_out->fit);
    json["held_out"]["frames"] = report.held_out->frames;
    json["held_out"]["noise_px"] = report.held_out->noise_px;
    json["held_out"]["length_mean_mm"] = report.held_out->length_mean_mm;
    json["held_out"]["length_rms_mm"] = report.held_out->length_rms_mm;
  }
  json["grade"] = report.grade;
  json["grade_text"] = report.meaning;
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
             report.volume.median_mm, report.volume.worst_tenth_mm, 100 * report.volume.observed_by_three);
  fmt::print("grade: {} ({})\n", report.grade, report.meaning);
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
}

/// Writes the rig, and says how well it is known.
void finish(const pipeline::calibrate::WandCalibration& result, const CalibrateWand& command) {
  warn(result.warnings);
  format::rig::write_rig(result.found.rig, command.out);
  if (command.json) {
    print(as_json(result.found));
  } else if (!command.quiet) {
    print_table(result.found);
    fmt::print("rig: {}\n", command.out);
  }
}

/// The floor where the L-frame lies now; of a rig without scale its size too.
pipeline::calibrate::GroundCalibration ground_by_l_frame(const Rig& rig, const pipeline::calibrate::CalibrateWandOptions& options,
                                                         const std::string& frame) {
  const bool scale = options.wand.distances.size() < 2 && !options.how.distance;
  return with_progress(true, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_ground(
        rig, {.board = {}, .frame = ground_frame_of(frame), .observations = {}, .markers = options.markers, .scale = scale}, hooks);
  });
}

/// Waved before live cameras, watched on the terminal and on a page.
void calibrate_live(const Rig& rig, pipeline::calibrate::CalibrateWandOptions options, const CalibrateWand& command) {
  std::atomic<bool> will_do = false;
  const CalibrationSubject subject{.job = "wand",
                                   .invitation = "wave the wand through the whole volume",
                                   .criteria = calibrate::wand::WandCoverage::criteria(pipeline::calibrate::knows_lenses(rig))};
  std::optional<CalibrationPage> page;
  const auto camera_settings = std::make_shared<pipeline::live::CameraSettings>(rig, options.markers.threshold);
  options.camera_settings = camera_settings.get();
  if (command.view) {
    page.emplace(
        subject,
        CalibrationPage::Options{.location = command.web,
                                 .allow_control = command.allow_control,
                                 .ground = [&](const Rig& found) { return ground_by_l_frame(found, options, command.frame); },
                                 .enough = [&] { will_do = true; }},
        rig, camera_settings);
  }
  CalibrationScreen screen(command.quiet);
  const Keys keys([&](char key) { will_do = will_do || key == 'q'; });
  screen.begun(subject, keys.listens());
  options.waving = [&](const pipeline::calibrate::LiveObserved& detected) {
    screen.show(detected);
    if (page) page->show(detected);
    return !will_do;
  };
  options.waved = [&] {
    if (page) page->computing();
  };
  try {
    const pipeline::calibrate::WandCalibration result =
        with_progress(true, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_wand(rig, options, hooks); });
    screen.end();
    finish(result, command);
    if (page) page->done(result.found.rig, as_json(result.found), command.out);
  } catch (const Error& error) {
    if (page) page->failed(error.what());
    throw;
  }
}

void run(const CalibrateWand& command) {
  pipeline::calibrate::CalibrateWandOptions options = command.options;
  options.observations = observations_of(command.inputs);
  options.wand = wand_of(command.wand);
  options.how.distance = distance_of(command.distance);
  const Rig rig = rig_of(command.inputs);
  if (options.observations.empty() && pipeline::calibrate::has_live_cameras(rig)) return calibrate_live(rig, options, command);
  if (command.view) throw WrongUsage("--view: shows live cameras; those of this rig are not");
  finish(with_progress(command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_wand(rig, options, hooks); }),
         command);
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
  command.flag("--synced", options->options.synced, "the cameras' clocks are right: search for no time offsets");
  command.seed(options->options.how.seed, "of the random draws");
  command.number("--duration", options->options.wave_s, "s", closed(1, 36'000),
                 "live cameras: the wand is waved until all have seen enough of it, at most this long");
  pipeline::jobs::Table rows;
  add_threshold_row(rows, options->options.markers.threshold);
  command.rows(std::move(rows));
  command.flag("--dark", options->options.markers.dark, "markers are darker than what is around them");
  command.group("To be watched");
  command.flag("--view", options->view,
               "live cameras: a page that shows them and what they saw of the wand; its address is printed");
  add_listen_address(command, options->web);
  add_ground_frame(command, options->frame,
                   "on the page: where the markers of an L-frame lie by which it sets the ground: X,Y;X,Y;… in m");
  command.flag("--allow-control", options->allow_control, "a page that others can open (--listen) may change cameras");
  command.group("");
  command.reports(options->json, options->quiet, "table");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

#include "marey/pipeline/calibrate/calibrate_lens.h"

#include <cstdio>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/draw/coverage_plot.h"
#include "marey/files/whole_file.h"
#include "marey/format/rig/rig_file.h"

#include "board_option.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibrateLens {
  std::string input, board, out, image;
  std::string name = "camera";
  pipeline::calibrate::LensRunOptions run;
  bool json = false;
  bool quiet = false;
};

Json as_json(const CalibrateLens& command, const pipeline::calibrate::LensRun& run) {
  const calibrate::LensCalibration& found = run.calibration;
  const Json figures = {
      {"mean_px", found.mean_px}, {"rms_px", found.rms_px}, {"inliers", found.inliers}, {"observations", found.observations}};
  Json camera = figures;
  const Vector<2>& focal = geometry::focal_of(found.lens);
  const Vector<2>& principal = geometry::principal_of(found.lens);
  camera["size"] = {found.size.width, found.size.height};
  camera["model"] = geometry::name_of(found.lens);
  camera["focal"] = {focal.x(), focal.y()};
  camera["principal"] = {principal.x(), principal.y()};
  camera["distortion"] = std::visit([](const auto& lens) { return Json(lens.distortion); }, found.lens);
  camera["covered"] = found.covered;
  camera["deviation"] = {{"focal", found.deviation.focal * focal.x()},
                         {"principal", {found.deviation.principal.x(), found.deviation.principal.y()}},
                         {"distortion", found.deviation.distortion}};
  for (const calibrate::LensCalibration::View& view : found.views) {
    Json entry = {{"name", view.name}, {"rms_px", view.rms_px}};
    if (!view.refused.empty()) entry["refused"] = view.refused;
    camera["views"].push_back(std::move(entry));
  }
  return {{"all", figures}, {"cameras", {{command.name, camera}}}, {"warnings", found.warnings}};
}

void print_table(const pipeline::calibrate::LensRun& run) {
  const calibrate::LensCalibration& found = run.calibration;
  const Vector<2>& focal = geometry::focal_of(found.lens);
  const Vector<2>& principal = geometry::principal_of(found.lens);
  int used = 0;
  for (const calibrate::LensCalibration::View& view : found.views) used += view.refused.empty() ? 1 : 0;
  fmt::print("{} images, {} show the board, {} used; corners cover {:.0f} % of the image\n", run.frames, run.sightings, used,
             100 * found.covered);
  fmt::print("  error       {:8.3f} px RMS, {:.3f} px mean over {} of {} corners\n", found.rms_px, found.mean_px, found.inliers,
             found.observations);
  fmt::print("  focal       {:8.2f} {:8.2f} px  ± {:.2f}\n", focal.x(), focal.y(), found.deviation.focal * focal.x());
  fmt::print("  principal   {:8.2f} {:8.2f} px  ± {:.2f} {:.2f}\n", principal.x(), principal.y(), found.deviation.principal.x(),
             found.deviation.principal.y());
  fmt::print("  {:<8}   ", geometry::name_of(found.lens));
  std::visit(
      [&](const auto& lens) {
        for (std::size_t i = 0; i < lens.distortion.size(); ++i) {
          if (found.deviation.distortion[i] > 0) fmt::print(" {:.5f} ± {:.5f}", lens.distortion[i], found.deviation.distortion[i]);
        }
      },
      found.lens);
  fmt::print("\n");
  for (const calibrate::LensCalibration::View& view : found.views) {
    if (!view.refused.empty()) fmt::print("  not used: {}: {}\n", view.name, view.refused);
  }
}

Rig rig_of(const CalibrateLens& command, const calibrate::LensCalibration& found) {
  RigCamera camera;
  camera.name = command.name;
  camera.size = found.size;
  camera.lens = found.lens;
  camera.rms_px = found.rms_px;
  Rig rig;
  rig.cameras.push_back(std::move(camera));
  return rig;
}

void draw(const CalibrateLens& command, const calibrate::LensCalibration& found) {
  draw::CoveragePlot plot;
  plot.title = fmt::format("{}: {:.3f} px RMS over {} corners, {:.0f} % covered", command.name, found.rms_px, found.inliers,
                           100 * found.covered);
  plot.size = found.size;
  for (const calibrate::LensCalibration::View& view : found.views) {
    for (std::size_t i = 0; i < view.pixels.size(); ++i)
      plot.marks.push_back({view.pixels[i], i < view.errors.size() ? view.errors[i] : Vector<2>::Zero(), view.refused.empty()});
  }
  WholeFile file(command.image);
  file.write(draw::to_svg(plot));
  file.finish();
}

void run(const CalibrateLens& command) {
  const calibrate::board::Board board = calibrate::board::parse_board(command.board);
  const pipeline::calibrate::LensRun found = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_lens(command.input, board, command.run, hooks);
  });
  if (!command.out.empty()) format::rig::write_rig(rig_of(command, found.calibration), command.out);
  if (!command.image.empty()) draw(command, found.calibration);
  warn(found.calibration.warnings);
  if (command.json) {
    print(as_json(command, found));
  } else if (!command.quiet) {
    print_table(found);
    if (!command.out.empty()) fmt::print("rig: {}\n", command.out);
  }
}

}  // namespace

void add_calibrate_lens(Command& calibrate) {
  auto options = std::make_shared<CalibrateLens>();
  Command command = calibrate.subcommand("lens", "One camera's lens, from images of a board");
  command.input_file("INPUT", options->input, "a video, a folder of images or a pattern such as 'shot_%02d.jpg'").required();
  add_board(command, options->board).required();
  command.output_file("-o,--output", options->out, "rig file for the camera").ends_in({".toml"});
  std::vector<std::pair<std::string, std::string>> models;
  for (const auto& model : calibrate::lens_models()) models.emplace_back(model, model);
  command.choice("--model", options->run.lens.model, models, "of the lens");
  command.whole("--coefficients", options->run.lens.coefficients, "N", 0, 8,
                "how many of the model's distortion coefficients are sought");
  command.flag("--square-pixels", options->run.lens.square_pixels, "one focal length for both axes");
  command.text("--camera", options->name, "the camera's name in the rig");
  command.whole("--max-views", options->run.max_views, "N", 3, 1000, "images that the solution rests on, at most");
  command.output_file("--plot", options->image, "SVG of where corners were seen, with their errors").ends_in({".svg"});
  command.reports(options->json, options->quiet, "table");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

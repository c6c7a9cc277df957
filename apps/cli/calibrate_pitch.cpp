#include "marey/pipeline/calibrate/calibrate_pitch.h"

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_elements.h"
#include "pitch_size.h"
#include "rig_inputs.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct CalibratePitch {
  RigAndSources inputs;
  std::string out, images;
  std::vector<std::string> points;
  PitchElements elements;
  std::string size = "105x68";
  calibrate::pitch::GroundKnown ground = calibrate::pitch::GroundKnown::nothing;
  bool synced = false;
  bool json = false;
  bool quiet = false;
};

void run_elements(const CalibratePitch& command) {
  if (!command.inputs.rig.empty()) throw WrongUsage("--elements makes a rig: omit {}", command.inputs.rig);
  if (command.out.empty() && command.elements.cameras.empty())
    throw WrongUsage("--elements: -o FILE.toml, --soccernet-cameras FOLDER or both are needed");
  PitchElements elements = command.elements;
  elements.out = command.out, elements.size = command.size, elements.json = command.json, elements.quiet = command.quiet;
  run_pitch_elements(elements);
}

std::map<std::string, std::string> parse_points(const std::vector<std::string>& pairs) {
  std::map<std::string, std::string> result;
  for (const std::string& pair : pairs) {
    const auto equals = pair.find('=');
    if (equals == std::string::npos || equals == 0 || equals + 1 == pair.size())
      throw WrongUsage("--points {}: it must read CAMERA=FILE", pair);
    if (!result.emplace(pair.substr(0, equals), pair.substr(equals + 1)).second)
      throw WrongUsage("--points: camera \"{}\" is given twice", pair.substr(0, equals));
  }
  return result;
}

double deviation(const calibrate::pitch::PitchFit& fit, Eigen::Index number) {
  return std::sqrt(std::max(0.0, fit.covariance(number, number)));
}

double focal_deviation(const calibrate::pitch::PitchFit& fit, std::size_t camera) {
  using calibrate::pitch::CameraNumbers;
  return deviation(fit, static_cast<Eigen::Index>(camera) * CameraNumbers::count + CameraNumbers::focal);
}

Json ground_json(const calibrate::pitch::PitchFit& fit) {
  using geometry::GroundSurface;
  Json json{{"highest_m", fit.ground.height(fit.ground.middle)}};
  constexpr std::array<const char*, GroundSurface::kTerms> kNames{"across", "along", "dome", "ridge"};
  for (int i = 0; i < GroundSurface::kTerms; ++i) {
    const auto at = static_cast<std::size_t>(i);
    json[kNames[at]] = fit.ground.terms()[at];
    json[fmt::format("{}_deviation", kNames[at])] = deviation(fit, fit.covariance.rows() - GroundSurface::kTerms + i);
  }
  return json;
}

/// What the clicks that are used are off by.
struct ClickErrors {
  double sum = 0, square = 0;
  int good = 0, all = 0;

  void add(double error) { sum += error, square += error * error, ++good; }
  double mean() const { return sum / std::max(1, good); }
  double rms() const { return std::sqrt(square / std::max(1, good)); }
};

Json camera_json(const pipeline::calibrate::PitchRun& run, std::size_t camera, ClickErrors& of_all) {
  const calibrate::pitch::PitchViewResult& found = run.calibration.views[camera];
  ClickErrors own;
  Json points = Json::array();
  for (std::size_t k = 0; k < found.inlier.size(); ++k) {
    Json point = {{"name", run.views[camera].points[k].name}, {"error_px", found.error_px[k]}, {"used", found.inlier[k] != 0}};
    if (found.error_m[k]) point["error_m"] = *found.error_m[k];
    if (found.better_name[k]) point["fits"] = {found.better_name[k]->x(), found.better_name[k]->y()};
    points.push_back(std::move(point));
    ++own.all, ++of_all.all;
    if (found.inlier[k]) own.add(found.error_px[k]), of_all.add(found.error_px[k]);
  }
  return {{"focal_px", geometry::focal_of(found.camera.lens()).x()},
          {"focal_deviation_px", focal_deviation(run.calibration.fit, camera)},
          {"mean_px", own.mean()},
          {"rms_px", own.rms()},
          {"inliers", own.good},
          {"observations", own.all},
          {"lines",
           {{"sightings", found.lines.size()},
            {"median_px", found.line_median_px},
            {"p95_px", found.line_95_px},
            {"median_m", found.line_median_m},
            {"p95_m", found.line_95_m}}},
          {"points", points}};
}

Json as_json(const pipeline::calibrate::PitchRun& run) {
  Json cameras;
  ClickErrors all;
  for (std::size_t i = 0; i < run.views.size(); ++i) cameras[run.cameras[i]] = camera_json(run, i, all);
  Json offsets = Json::object();
  for (const pipeline::people::ground::RigOffsets::Camera& camera : run.offsets.cameras) {
    Json& entry = offsets[camera.name] = {{"verdict", calibrate::pitch::offset_verdict_name(camera.found.verdict)}};
    if (camera.found.verdict != calibrate::pitch::OffsetVerdict::found) continue;
    entry["offset_s"] = camera.offset_s;
    entry["found_s"] = camera.found.offset_s;
    entry["deviation_s"] = camera.found.deviation_s;
  }
  return {{"all", {{"mean_px", all.mean()}, {"rms_px", all.rms()}, {"inliers", all.good}, {"observations", all.all}}},
          {"cameras", cameras},
          {"ground", ground_json(run.calibration.fit)},
          {"lens_terms", run.calibration.fit.lens_terms},
          {"offsets", offsets},
          {"warnings", run.warnings}};
}

void print_ground(const calibrate::pitch::PitchFit& fit) {
  const geometry::GroundSurface& ground = fit.ground;
  const double middle = ground.height(ground.middle);
  if (ground.flat()) return fmt::print("the pitch is level, as far as clicks and lines tell\n");
  const double touchline = ground.height(ground.middle + Vector<2>(0, ground.half.y()));
  const double goal_line = ground.height(ground.middle + Vector<2>(ground.half.x(), 0));
  fmt::print(
      "the pitch is {:.2f} m above its corners in the middle, {:.2f} m halfway along the touchlines, {:.2f} m halfway along the "
      "goal lines\n",
      middle, touchline, goal_line);
}

void print_report(const pipeline::calibrate::PitchRun& run) {
  for (std::size_t i = 0; i < run.views.size(); ++i) {
    const calibrate::pitch::PitchViewResult& found = run.calibration.views[i];
    const Vector<3>& centre = found.camera.centre();
    const auto used = std::count(found.inlier.begin(), found.inlier.end(), 1);
    const Vector<2> location = (run.calibration.ground_from_world * centre.head<2>().homogeneous()).hnormalized();
    fmt::print("{}: {} of {} clicks used; the camera stands at ({:.1f}, {:.1f}), {:.1f} m up\n", run.cameras[i], used,
               found.inlier.size(), location.x(), location.y(), centre.z());
    fmt::print("  focal length  {:.1f} px (± {:.1f}), {} terms of distortion\n", geometry::focal_of(found.camera.lens()).x(),
               focal_deviation(run.calibration.fit, i), run.calibration.fit.lens_terms);
    if (!found.lines.empty())
      fmt::print("  white lines   {} places; {:.2f} px and {:.3f} m off in the middle, {:.2f} px and {:.3f} m for 95 %\n",
                 found.lines.size(), found.line_median_px, found.line_median_m, found.line_95_px, found.line_95_m);
    for (std::size_t k = 0; k < found.inlier.size(); ++k) {
      if (found.inlier[k]) continue;
      fmt::print("  omitted      the click on {} is {:.0f} px off", run.views[i].points[k].name, found.error_px[k]);
      if (found.error_m[k]) fmt::print(", {:.1f} m", *found.error_m[k]);
      if (found.better_name[k]) fmt::print("; it would fit ({:g},{:g})", found.better_name[k]->x(), found.better_name[k]->y());
      fmt::print("\n");
    }
  }
  print_ground(run.calibration.fit);
  for (const std::string& message_text : run.offsets.notes) fmt::print("{}\n", message_text);
  if (run.calibration.ground_from_world(1, 1) < 0)
    fmt::print("the clicks' y grows to the right of x: the rig keeps a right-handed world, and turns results back\n");
}

void run(const CalibratePitch& command) {
  if (!command.elements.files.empty()) return run_elements(command);
  const char* missing = command.inputs.rig.empty() ? "RIG, the file that names the cameras and their videos,"
                        : command.points.empty() ? "--points CAMERA=FILE, where points of the pitch are in an image of the camera,"
                        : command.out.empty()    ? "-o FILE.toml, the rig to write,"
                                                 : nullptr;
  if (missing != nullptr) throw WrongUsage("{} is missing; or give --elements alone", missing);
  const Rig rig = rig_of(command.inputs);
  pipeline::calibrate::PitchRunOptions options;
  options.pitch.size = parse_pitch_size(command.size);
  options.pitch.known = command.ground;
  options.images = command.images;
  options.synced = command.synced;
  const pipeline::calibrate::PitchRun found = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::calibrate::calibrate_pitch(rig, parse_points(command.points), options, hooks);
  });
  format::rig::write_rig(found.rig, command.out);
  warn(found.warnings);
  if (command.json) {
    print(as_json(found));
  } else if (!command.quiet) {
    print_report(found);
    fmt::print("rig: {}\n", command.out);
    if (!command.images.empty()) fmt::print("images: {}\n", command.images);
  }
}

/// What goes into the folder of images.
std::vector<std::string> images_of(const CalibratePitch& command) {
  if (command.images.empty()) return {};
  std::vector<std::string> files;
  for (const RigCamera& camera : rig_of(command.inputs).cameras) {
    const pipeline::calibrate::PitchImages images(command.images, camera.name);
    files.insert(files.end(), {images.overlay, images.accuracy});
  }
  return files;
}

}  // namespace

void add_calibrate_pitch(Command& calibrate) {
  auto options = std::make_shared<CalibratePitch>();
  Command command =
      calibrate.subcommand("pitch", "Lenses and places of cameras over a football pitch, from clicks and its white lines");
  Option rig = add_rig(command, options->inputs, "rig file: the cameras' names and sources");
  Option points =
      command.input_files("--points", options->points, "CAMERA=FILE: clicked points, CSV (x,y,u,v) or CVAT XML; once a camera");
  command
      .input_files("--elements", options->elements.files,
                   "labelled elements of the pitch, JSON as SoccerNet's calibration names them; in place of a rig and clicks")
      .excludes(points);
  command.text("--resolution", options->elements.resolution, "of the labelled images, WIDTHxHEIGHT in px").check(check_resolution);
  command.output_folder("--soccernet-cameras", options->elements.cameras,
                        "folder for SoccerNet's camera_NAME.json of each labelled image");
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  using calibrate::pitch::GroundKnown;
  constexpr std::array<std::pair<const char*, GroundKnown>, 3> kGrounds{
      {{"found", GroundKnown::nothing}, {"level", GroundKnown::level}, {"kept", GroundKnown::wholly}}};
  command.choice("--ground", options->ground, kGrounds,
                 "how high the pitch is in the middle: found, as far as clicks and lines tell; level; or as the rig file says");
  command.output_file("-o,--output", options->out, "rig file to write").ends_in({".toml"}).may_replace(rig);
  command.output_folder("--plots", options->images,
                        "folder for the pitch drawn over each camera's image, and maps of the accuracy");
  command.also_writes([options] { return images_of(*options); });
  command.flag(
      "--synced", options->synced,
      "the cameras run on one clock; else when each was started is found from how people move, where the rig does not specify");
  command.reports(options->json, options->quiet, "report");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

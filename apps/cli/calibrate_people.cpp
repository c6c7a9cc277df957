#include "marey/pipeline/calibrate/calibrate_people.h"

#include <atomic>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/calibrate/people/people_coverage.h"
#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/calibrate/live_blobs.h"
#include "marey/pipeline/jobs/reconstruct.h"

#include "calibration_page.h"
#include "camera_distance.h"
#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "live_screen.h"
#include "phones_screen.h"
#include "rig_inputs.h"
#include "run_hooks.h"
#include "view_options.h"

namespace marey::cli {
namespace {

struct CalibratePeople {
  std::vector<std::string> inputs;
  std::string distance, out;
  pipeline::jobs::CalibratePeople job;
  bool view = false, allow_control = false;
  viewer::ListenAddress web;
  bool synced = false, json = false, quiet = false;
};

/// `[RIG] CAMERA=VIDEO …`: without a rig each pair is a camera.
Rig people_rig_of(const std::vector<std::string>& inputs) {
  std::vector<std::string> sources(inputs.begin(), inputs.end());
  std::error_code error;
  const bool with_rig =
      !inputs.empty() && (std::filesystem::exists(inputs.front(), error) || inputs.front().find('=') == std::string::npos);
  Rig rig;
  if (with_rig) {
    rig = format::rig::read_rig(inputs.front());
    sources.erase(sources.begin());
  } else {
    for (const std::string& source : sources) rig.cameras.emplace_back().name = source.substr(0, source.find('='));
  }
  set_sources(rig, sources);
  return rig;
}

Json as_json(const calibrate::people::PeopleRig& result) {
  const calibrate::RigReport& report = result.report;
  Json json = {{"people", result.people},
               {"height_m", result.height},
               {"rms_px", report.all.rms_px},
               {"inliers", report.all.inliers},
               {"observations", report.all.observations},
               {"cameras", Json::object()}};
  for (std::size_t c = 0; c < report.cameras.size(); ++c) {
    const calibrate::CameraReport& camera = report.cameras[c];
    json["cameras"][camera.name] = {{"rms_px", camera.fit.rms_px},
                                    {"inliers", camera.fit.inliers},
                                    {"observations", camera.fit.observations},
                                    {"coverage", camera.coverage},
                                    {"offset_s", result.rig.cameras[c].offset_s.value_or(0)},
                                    {"deviation",
                                     {{"centre_mm", 1000 * camera.deviation.centre.norm()},
                                      {"rotation_rad", camera.deviation.rotation.norm()},
                                      {"focal", camera.deviation.focal}}}};
  }
  json["notes"] = result.notes;
  return json;
}

void print_table(const calibrate::people::PeopleRig& result) {
  fmt::print("{:<16} {:>8} {:>9} {:>9} {:>9} {:>10} {:>9} {:>10}\n", "camera", "rms px", "inliers", "of", "coverage", "place ±cm",
             "focal ±%", "offset s");
  for (std::size_t c = 0; c < result.report.cameras.size(); ++c) {
    const calibrate::CameraReport& camera = result.report.cameras[c];
    fmt::print("{:<16} {:>8.2f} {:>9} {:>9} {:>7.0f} % {:>10.1f} {:>9.1f} {:>10.3f}\n", camera.name, camera.fit.rms_px,
               camera.fit.inliers, camera.fit.observations, 100 * camera.coverage, 100 * camera.deviation.centre.norm(),
               100 * camera.deviation.focal, result.rig.cameras[c].offset_s.value_or(0));
  }
  fmt::print("{} {} seen by two cameras or more; height {:.2f} m; the floor is z = 0\n", result.people,
             result.people == 1 ? "person" : "people", result.height);
  for (const std::string& note : result.notes) fmt::print("note: {}\n", note);
}

/// Writes the rig, and says how well it is known.
void finish(const pipeline::calibrate::PeopleCalibration& result, const CalibratePeople& command) {
  warn(result.warnings);
  format::rig::write_rig(result.found.rig, command.out);
  if (command.json) {
    print(as_json(result.found));
  } else if (!command.quiet) {
    print_table(result.found);
    fmt::print("rig: {}\n", command.out);
  }
}

/// People walk before live cameras, watched on the terminal and on a page.
void calibrate_live(const Rig& rig, pipeline::calibrate::CalibratePeopleOptions options, const CalibratePeople& command) {
  std::atomic<bool> will_do = false;
  const CalibrationSubject subject{.job = "people",
                                   .invitation = "let one person walk through the whole volume, near and far",
                                   .criteria = calibrate::people::PeopleCoverage::criteria()};
  const auto camera_settings = std::make_shared<pipeline::live::CameraSettings>(rig);
  pipeline::calibrate::LivePeopleOptions& live = options.live;
  live.camera_settings = camera_settings.get();
  live.folder = std::filesystem::path(command.out).replace_extension().string() + "_video";
  std::optional<CalibrationPage> page;
  if (command.view) {
    page.emplace(subject,
                 CalibrationPage::Options{
                     .location = command.web, .allow_control = command.allow_control, .enough = [&] { will_do = true; }},
                 rig, camera_settings);
  }
  const PhonesScreen phones(rig);
  phones.invite();
  CalibrationScreen screen(command.quiet);
  const Keys keys([&](char key) { will_do = will_do || key == 'q'; });
  screen.begun(subject, keys.listens());
  live.walking = [&](const pipeline::calibrate::LiveObserved& detected) {
    screen.show(detected);
    if (page) page->show(detected);
    return !will_do;
  };
  live.walked = [&] {
    screen.end();
    if (page) page->computing();
  };
  try {
    const pipeline::calibrate::PeopleCalibration result = with_progress(
        command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_people(rig, options, hooks); });
    finish(result, command);
    if (page) page->done(result.found.rig, as_json(result.found), command.out);
  } catch (const Error& error) {
    if (page) page->failed(error.what());
    throw;
  }
}

void run(const CalibratePeople& command) {
  pipeline::calibrate::CalibratePeopleOptions options = resolved(command.job);
  options.how.distance = distance_of(command.distance);
  if (command.synced) options.how.max_offset_s = 0;
  const Rig rig = people_rig_of(command.inputs);
  if (pipeline::calibrate::has_live_cameras(rig)) return calibrate_live(rig, options, command);
  if (command.view) throw WrongUsage("--view: shows live cameras; those of this rig are not");
  if (!options.how.height && !options.how.distance)
    warn({"neither --height nor --distance is given: the scale is unknown, and a typical height is taken"});
  finish(
      with_progress(command.quiet, [&](const Hooks& hooks) { return pipeline::calibrate::calibrate_people(rig, options, hooks); }),
      command);
}

}  // namespace

void add_calibrate_people(Command& calibrate) {
  auto options = std::make_shared<CalibratePeople>();
  Command command = calibrate.subcommand("people", "Where the cameras stand, from people who walk before them: no board, no wand");
  const Option inputs =
      command
          .input_files(
              "INPUTS", options->inputs,
              "CAMERA=VIDEO of each camera, or its keypoints (OpenPose, COCO, a take), or a live camera (phone:NAME, v4l2:…, "
              "play:VIDEO; their videos are kept beside the rig); before them a rig file, where one knows the cameras' "
              "names, sizes, lenses or offsets")
          .required();
  const Option height =
      command.number("--height", options->job.options.how.height, "m", closed(0.5, 2.6), "how tall the people are, for the scale");
  command.text("--distance", options->distance, "CAM1,CAM2=METRES: how far two cameras stand apart, for the scale")
      .check([](const std::string& text) { distance_of(text); })
      .excludes(height);
  command.output_file("-o,--output", options->out, "the rig file that is written")
      .required()
      .ends_in({".toml"})
      .may_replace(inputs);
  command.flag("--synced", options->synced, "the cameras' clocks are right: search for no time offsets");
  command.number("--max-offset", options->job.options.how.max_offset_s, "s", closed(0.01, 10),
                 "the largest offset between two cameras that is searched; walking alone repeats itself with every stride");
  command.seed(options->job.options.how.seed, "of the random draws");
  command.number("--duration", options->job.options.live.walk_s, "s", closed(1, 36'000),
                 "live cameras: people walk until they were seen enough, at most this long");
  command.rows(table_of(options->job));
  command.group("To be watched");
  command.flag("--view", options->view, "live cameras: a page that shows them and what they saw of people; its address is printed");
  add_listen_address(command, options->web);
  command.flag("--allow-control", options->allow_control, "a page that others can open (--listen) may change cameras");
  command.group("");
  command.reports(options->json, options->quiet, "table");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

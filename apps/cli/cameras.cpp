#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/live/live_feeds.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"

namespace marey::cli {
namespace {

using source::live::FoundCamera;

struct CamerasCommand {
  std::string rig;
  bool json = false, quiet = false;
};

std::string rates_text(const FoundCamera::Mode& mode) {
  std::string text;
  for (const double rate : mode.rates_hz) text += fmt::format("{}{:g}", text.empty() ? "  " : ", ", rate);
  return text.empty() ? text : text + " Hz";
}

Json as_json(const FoundCamera& camera) {
  Json json = {{"source", camera.source}, {"name", camera.name}, {"where", camera.where}};
  json["modes"] = Json::array();
  for (const FoundCamera::Mode& mode : camera.modes)
    json["modes"].push_back(
        {{"format", mode.format}, {"width", mode.size.width}, {"height", mode.size.height}, {"rates_hz", mode.rates_hz}});
  json["controls"] = Json::object();
  for (const FoundCamera::Control& control : camera.controls)
    json["controls"][control.name] = {{"min", control.minimum}, {"max", control.maximum}, {"now", control.now}};
  return json;
}

void print_camera(const FoundCamera& camera) {
  fmt::print("{}  {} ({})\n", camera.source, camera.name, camera.where);
  for (const FoundCamera::Mode& mode : camera.modes)
    fmt::print("  {} {}x{}{}\n", mode.format, mode.size.width, mode.size.height, rates_text(mode));
  for (const FoundCamera::Control& control : camera.controls)
    fmt::print("  {}: {:g} to {:g}, now {:g}\n", control.name, control.minimum, control.maximum, control.now);
}

/// Its first mode is what it gives unless another is requested.
Rig rig_of(const std::vector<FoundCamera>& found) {
  Rig rig;
  for (const FoundCamera& each : found) {
    RigCamera& camera = rig.cameras.emplace_back();
    camera.name = fmt::format("cam{}", rig.cameras.size());
    camera.source = each.source;
    if (each.modes.empty()) continue;
    const FoundCamera::Mode& mode = each.modes.front();
    camera.size = mode.size;
    if (each.source.starts_with("v4l2:")) camera.source += fmt::format("?size={}x{}", mode.size.width, mode.size.height);
    if (!mode.rates_hz.empty()) camera.rate_hz = mode.rates_hz.front();
  }
  return rig;
}

void run(const CamerasCommand& command) {
  const std::vector<FoundCamera> found = source::live::find_cameras();
  if (command.json) {
    Json all = Json::array();
    for (const FoundCamera& camera : found) all.push_back(as_json(camera));
    print({{"cameras", all}, {"rig", path_or_null(found.empty() ? "" : command.rig)}});
  } else if (!command.quiet) {
    for (const FoundCamera& camera : found) print_camera(camera);
    if (found.empty()) {
      fmt::print(stderr, "no camera is plugged in; these can be named without being found:\n");
      for (const auto& kind : pipeline::live::live_kinds()) fmt::print(stderr, "  {:<52} {}\n", kind.form, kind.meaning);
    }
  }
  if (command.rig.empty()) return;
  if (found.empty()) throw Error("{}: is not written, because no camera was found", command.rig);
  format::rig::write_rig(rig_of(found), command.rig);
  if (!command.quiet && !command.json) fmt::print(stderr, "rig: {}\n", command.rig);
}

}  // namespace

void add_cameras(Command& program) {
  auto options = std::make_shared<CamerasCommand>();
  Command command = program.subcommand("cameras", "List the cameras that are plugged in, and write a first rig of them");
  command.output_file("-o,--output", options->rig, "a rig of all of them: RIG.toml").ends_in({".toml"});
  command.reports(options->json, options->quiet, "list");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

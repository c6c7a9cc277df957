#include "track_ground.h"

#include <filesystem>

#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/files/overwriting.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_turns.h"

#include "command_line.h"
#include "ground_summary.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

pipeline::people::GroundOutput output_of(const GroundCommand& command) {
  pipeline::people::GroundOutput output = command.job.output;
  output.tracks = command.out;
  const char* typical = command.out.ends_with(".marey") ? "take" : output.boxes_of.empty() ? "csv" : "mot";
  const std::string format = command.format.empty() ? typical : command.format;
  if (format != "csv" && format != "take" && format != "mot")
    throw WrongUsage("--format {}: places on the ground are written as csv or take, the boxes in one camera's view as mot", format);
  if (format == "mot" && output.boxes_of.empty())
    throw WrongUsage("--format mot holds the boxes in one camera's view; name the camera with --camera");
  if (format != "mot" && !output.boxes_of.empty())
    throw WrongUsage("--camera {} is for --format mot; places on the ground are those of all cameras together", output.boxes_of);
  const char* ending = format == "mot" ? ".txt" : format == "take" ? ".marey" : ".csv";
  if (format == "take" && !command.out.empty() && !command.out.ends_with(ending))
    throw WrongUsage("--output {}: a take's name ends in .marey", command.out);
  if (command.format.empty() && !command.out.empty() && !is_stream(command.out) && !command.out.ends_with(ending))
    throw WrongUsage("--output {}: {} is written, so its name ends in {}; or name the format with --format", command.out, format,
                     ending);
  if (command.out == "-") output.tracks = "/dev/stdout";
  if (command.out.empty())
    output.tracks =
        std::filesystem::path(command.rig).stem().string() + (format == "mot" ? "_tracks.txt" : std::string("_ground") + ending);
  return output;
}

}  // namespace

std::vector<std::string> ground_files(const GroundCommand& command) {
  std::vector<std::string> files;
  if (command.out.empty()) files.push_back(output_of(command).tracks);
  std::error_code error;
  if (!std::filesystem::is_regular_file(command.rig, error)) return files;
  const std::vector<std::string> overlays = pipeline::people::overlays_of(format::rig::read_rig(command.rig), command.job.output);
  files.insert(files.end(), overlays.begin(), overlays.end());
  return files;
}

void track_on_ground(GroundCommand command) {
  Rig rig = format::rig::read_rig(command.rig);
  set_sources(rig, command.sources);
  const pipeline::people::GroundOutput output = output_of(command);
  command.job.rig_name = command.rig;
  pipeline::people::PeopleOnGroundOptions options = resolved(command.job, rig);
  options.ptz = format::rig::read_ptz(command.rig);
  run_with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::people::track_ground(rig, output, options, hooks); },
      [&](const pipeline::people::GroundSummary& summary, double elapsed) {
        if (command.json) {
          print_json(summary, output, elapsed);
        } else if (!command.quiet) {
          print_summary(summary, output, elapsed);
        }
      });
}

}  // namespace marey::cli

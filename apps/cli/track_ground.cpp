#include "track_ground.h"

#include <filesystem>

#include "marey/core/error.h"
#include "marey/core/rig_sources.h"
#include "marey/core/stop.h"
#include "marey/files/overwriting.h"
#include "marey/files/temporary_file.h"
#include "marey/format/register.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_ptz.h"
#include "marey/pipeline/take/convert.h"

#include "command_line.h"
#include "ground_summary.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

constexpr const char* kBoxes = "mot";  // with --camera: the boxes in its view

void check_boxes(const GroundCommand& command, const std::string& camera) {
  const bool named_mot = command.format == kBoxes || (command.format.empty() && !camera.empty());
  if (command.format == kBoxes && camera.empty())
    throw WrongUsage("--format mot holds the boxes in one camera's view; name the camera with --camera");
  if (!named_mot && !camera.empty())
    throw WrongUsage("--camera {} is for --format mot; places on the ground are those of all cameras together", camera);
  if (named_mot && command.format.empty() && !command.out.empty() && !is_stream(command.out) && !command.out.ends_with(".txt"))
    throw WrongUsage("--output {}: mot is written, so its name ends in .txt; or name the format with --format", command.out);
}

pipeline::people::ground::GroundOutput output_of(const GroundCommand& command) {
  pipeline::people::ground::GroundOutput output = command.job.output;
  output.tracks = command.out == "-" ? "/dev/stdout" : command.out;
  check_boxes(command, output.boxes_of);
  const std::string stem = std::filesystem::path(command.rig).stem().string();
  if (!output.boxes_of.empty()) {
    if (command.out.empty()) output.tracks = stem + "_tracks.txt";
    return output;
  }
  const bool unnamed = command.out.empty() || is_stream(command.out);
  const std::string name = command.format.empty() && unnamed ? "csv" : command.format;
  const format::Format& format = format::format_to_write(unnamed ? std::string() : command.out, name, format::Content::ground);
  if (format.name == kBoxes)
    throw WrongUsage(
        "--output {}: a name that ends in .txt is of the boxes in one camera's view; name the camera with --camera, or end "
        "the name in .csv",
        command.out);
  if (format.name == "take" && !command.out.empty() && !command.out.ends_with(".marey"))
    throw WrongUsage("--output {}: a take's name ends in .marey", command.out);
  output.format = format.name;
  if (command.out.empty()) output.tracks = stem + "_ground" + first_ending(format);
  return output;
}

bool is_written_whole(const pipeline::people::ground::GroundOutput& output) {
  if (!output.boxes_of.empty()) return false;
  return format::format_named(output.format, format::Content::ground)->create == nullptr;
}

/// Formats that begin with what only the end gives are written from a take that is gone afterwards.
pipeline::people::ground::GroundSummary track_to(const Rig& rig, const pipeline::people::ground::GroundOutput& output,
                                                 const pipeline::people::ground::PeopleOnGroundOptions& options,
                                                 const Hooks& hooks) {
  if (!is_written_whole(output)) return pipeline::people::ground::track_ground(rig, output, options, hooks);
  pipeline::people::ground::GroundOutput recorded = output;
  recorded.tracks = output.tracks + ".part.marey", recorded.format = "take";
  const TemporaryFile take(recorded.tracks);
  pipeline::people::ground::GroundSummary summary = pipeline::people::ground::track_ground(rig, recorded, options, hooks);
  const StopScope keeps_partial_results{{}};  // of a run that was stopped too
  pipeline::take::ConvertOptions how;
  how.format = output.format;
  for (std::string& warning : pipeline::take::convert(recorded.tracks, output.tracks, how).warnings)
    summary.warnings.push_back(std::move(warning));
  return summary;
}

}  // namespace

std::vector<std::string> ground_files(const GroundCommand& command) {
  std::vector<std::string> files;
  const pipeline::people::ground::GroundOutput output = output_of(command);
  if (command.out.empty()) files.push_back(output.tracks);
  if (const std::string second = format::companion_file(output.tracks); !second.empty() && is_written_whole(output))
    files.push_back(second);
  std::error_code error;
  if (!std::filesystem::is_regular_file(command.rig, error)) return files;
  const std::vector<std::string> overlays =
      pipeline::people::ground::overlays_of(format::rig::read_rig(command.rig), command.job.output);
  files.insert(files.end(), overlays.begin(), overlays.end());
  return files;
}

void track_on_ground(GroundCommand command) {
  Rig rig = format::rig::read_rig(command.rig);
  set_sources(rig, command.sources);
  const pipeline::people::ground::GroundOutput output = output_of(command);
  command.job.rig_name = command.rig;
  pipeline::people::ground::PeopleOnGroundOptions options = resolved(command.job, rig);
  options.ptz = format::rig::read_ptz(command.rig);
  run_with_progress(
      command.quiet, [&](const Hooks& hooks) { return track_to(rig, output, options, hooks); },
      [&](const pipeline::people::ground::GroundSummary& summary, double elapsed) {
        if (command.json) {
          print_json(summary, output, elapsed);
        } else if (!command.quiet) {
          print_summary(summary, output, elapsed);
        }
      });
}

}  // namespace marey::cli

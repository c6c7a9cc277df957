#include "track_ground.h"

#include <filesystem>

#include "marey/core/error.h"
#include "marey/core/overwriting.h"
#include "marey/core/rig_sources.h"
#include "marey/filter/usual_motion.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_turns.h"
#include "marey/pipeline/people/track_ground.h"

#include "command_line.h"
#include "ground_summary.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

pipeline::people::GroundOutput output_of(const GroundCommand& command, const GroundFlags& flags) {
  pipeline::people::GroundOutput output{
      .tracks = command.out, .boxes_of = flags.camera, .overlays = command.overlay, .pitch_view = flags.pitch_view};
  const char* usual = command.out.ends_with(".marey") ? "take" : flags.camera.empty() ? "csv" : "mot";
  const std::string format = command.format.empty() ? usual : command.format;
  if (format != "csv" && format != "take" && format != "mot")
    throw WrongUsage("--format {}: places on the ground are written as csv or take, the boxes in one camera's view as mot", format);
  if (format == "mot" && flags.camera.empty())
    throw WrongUsage("--format mot holds the boxes in one camera's view; name the camera with --camera");
  if (format != "mot" && !flags.camera.empty())
    throw WrongUsage("--camera {} is for --format mot; places on the ground are those of all cameras together", flags.camera);
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

pipeline::people::PeopleOnGroundOptions options_of(const GroundCommand& command, const GroundFlags& flags,
                                                   const PeopleFlags& people, const Rig& rig) {
  check_every(people, true);
  pipeline::people::PeopleOnGroundOptions options;
  options.detector = detector_options(people);
  options.rate_hz = command.rate_hz;
  options.steady = people.steady;
  if (!command.filter.empty()) options.tracker.filter = filter::filter_for_people_on_ground(command.filter);
  apply(flags.where, rig, command.rig, command.live, !command.filter.empty(), options);
  if (flags.ball && command.live)
    throw WrongUsage("{}", "--ball looks at the whole recording before it tells where the ball was; leave out --live or --ball");
  if (flags.ball) options.ball.emplace();
  return options;
}

}  // namespace

void add_ground_options(Command& command, GroundFlags& flags) {
  command.group("Options for --ground");
  const Option ground =
      command.flag("--ground", flags.ground, "INPUT is a rig file: follow people on the ground its cameras look at");
  command.input_files("SOURCES", flags.sources, "with --ground: CAMERA=FILE, in place of the rig's source or detections");
  add_ground_area_options(command, ground, flags.where);
  command.flag("--ball", flags.ball, "follow the ball too: a track named \"ball\", with its height").needs(ground);
  command.text("--camera", flags.camera, "with --format mot: in whose view").needs(ground);
  command.output_file("--pitch-view", flags.pitch_view, "a film of the ground from above, with everybody's trail: FILE.mp4")
      .needs(ground)
      .ends_in({".mp4"});
  command.group("");
}

std::vector<std::string> ground_files(const GroundCommand& command, const GroundFlags& flags) {
  std::vector<std::string> files;
  if (command.out.empty()) files.push_back(output_of(command, flags).tracks);
  std::error_code error;
  if (command.overlay.empty() || !std::filesystem::is_regular_file(command.rig, error)) return files;
  for (const RigCamera& camera : format::rig::read_rig(command.rig).cameras)
    files.push_back((std::filesystem::path(command.overlay) / (camera.name + ".mp4")).string());
  return files;
}

void track_on_ground(const GroundCommand& command, const GroundFlags& flags, const PeopleFlags& people) {
  if (flags.where.association == "bramble" && (!people.detector.empty() || !command.filter.empty() || !flags.where.teams.empty()))
    throw WrongUsage("--associate bramble has a likelihood and a motion of its own and sees no clothes; leave out --{}",
                     !people.detector.empty()  ? "detector"
                     : !command.filter.empty() ? "filter"
                                               : "teams");
  if (people.outline) throw WrongUsage("--outline follows outlines in one picture; leave it out with --ground");
  Rig rig = format::rig::read_rig(command.rig);
  set_sources(rig, flags.sources);
  const pipeline::people::GroundOutput output = output_of(command, flags);
  pipeline::people::PeopleOnGroundOptions options = options_of(command, flags, people, rig);
  options.turning = format::rig::read_turning(command.rig);
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

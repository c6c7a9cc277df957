#include "track_ground.h"

#include <algorithm>
#include <filesystem>

#include "marey/core/error.h"
#include "marey/core/overwriting.h"
#include "marey/core/rig_sources.h"
#include "marey/filter/usual_motion.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/rig/rig_turns.h"
#include "marey/pipeline/track_ground.h"

#include "command_line.h"
#include "ground_summary.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

pipeline::GroundOutput output_of(const GroundCommand& command, const GroundFlags& flags) {
  pipeline::GroundOutput output{
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

/// Hypotheses are decided later, and live nobody waits for that.
track::ground::GroundAssociation usual_association(bool live) {
  return live ? track::ground::GroundAssociation::gnn : track::ground::GroundAssociation::mht;
}

/// Beside decoding and looking at pictures hypotheses cost little; boxes come too fast for them.
bool has_pictures(const Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return !camera.source.empty(); });
}

/// A rig that was calibrated over a pitch has one; any other has none unless it is told.
pipeline::PeopleOnGroundOptions options_of(const GroundCommand& command, const GroundFlags& flags, const PeopleFlags& people,
                                           const Rig& rig) {
  pipeline::PeopleOnGroundOptions options;
  options.detector = detector_options(people);
  options.rate_hz = command.rate_hz;
  if (!flags.teams.empty()) options.teams.names = analyse::parse_teams(flags.teams);
  options.live = command.live;
  options.steady = people.steady;
  options.learn.walk = command.filter.empty();
  if (!command.filter.empty()) options.tracker.filter = filter::filter_for_people_on_ground(command.filter);
  options.tracker.associate =
      flags.associate.empty() ? usual_association(command.live) : track::ground::ground_association_named(flags.associate);
  options.learn.association = flags.associate.empty() && !has_pictures(rig);
  const bool over_pitch = rig.calibration && rig.calibration->method == "pitch";
  if (!flags.area.empty()) {
    options.area = parse_area(flags.area);
  } else if (!flags.size.empty()) {
    options.pitch = parse_pitch_or_rectangle(flags.size);
    if (!options.pitch) options.area = parse_area(flags.size);
  } else if (over_pitch) {
    options.pitch.emplace();
  }
  if (flags.margin && !options.pitch && options.area.empty())
    throw WrongUsage("--margin is counted from the edge of a pitch or an area, and {} tells of none; give its --size or --area",
                     command.rig);
  options.margin = flags.margin.value_or(options.margin);
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
  command
      .text("--size", flags.size,
            "of the pitch, or of any other rectangle from the origin on, LENGTHxWIDTH in m (default: 105x68 where the rig was "
            "calibrated over a pitch, else people count everywhere)")
      .needs(ground)
      .check(parse_pitch_or_rectangle);
  command
      .text("--area", flags.area,
            "where people count, in place of a pitch: its corners in order, \"x,y x,y x,y\" in m, or LENGTHxWIDTH")
      .needs(ground)
      .check(parse_area);
  command
      .number("--margin", flags.margin, "m", closed(0, 1000), "round the pitch or the area where people still count (default: 2)")
      .needs(ground);
  command.text("--teams", flags.teams, "the teams' colours, \"white,blue\", or what they are called, \"City=white,United=blue\"")
      .needs(ground)
      .check(analyse::parse_teams);
  command
      .text("--associate", flags.associate,
            "how observations are associated with tracks: gnn, jpda or mht (default: mht; gnn with --live, and for boxes where "
            "cameras agree); or bramble, which looks at pictures by particles, without detections")
      .needs(ground)
      .check(track::ground::ground_association_named);
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
  if (flags.associate == "bramble" && (!people.detector.empty() || !command.filter.empty() || !flags.teams.empty()))
    throw WrongUsage("--associate bramble has a likelihood and a motion of its own and sees no clothes; leave out --{}",
                     !people.detector.empty()  ? "detector"
                     : !command.filter.empty() ? "filter"
                                               : "teams");
  if (people.outline) throw WrongUsage("--outline follows outlines in one picture; leave it out with --ground");
  Rig rig = format::rig::read_rig(command.rig);
  set_sources(rig, flags.sources);
  const pipeline::GroundOutput output = output_of(command, flags);
  pipeline::PeopleOnGroundOptions options = options_of(command, flags, people, rig);
  options.turning = format::rig::read_turning(command.rig);
  run_with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::track_ground(rig, output, options, hooks); },
      [&](const pipeline::GroundSummary& summary, double elapsed) {
        if (command.json) {
          print_json(summary, output, elapsed);
        } else if (!command.quiet) {
          print_summary(summary, output, elapsed);
        }
      });
}

}  // namespace marey::cli

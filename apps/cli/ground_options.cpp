#include "ground_options.h"

#include <algorithm>

#include "pitch_size.h"

namespace marey::cli {
namespace {

/// Hypotheses are decided later, and live output cannot wait for that.
track::ground::GroundAssociation default_association(bool live) {
  return live ? track::ground::GroundAssociation::gnn : track::ground::GroundAssociation::mht;
}

/// Next to decoding and processing images hypotheses cost little; detections arrive too fast for them.
bool has_pictures(const Rig& rig) {
  return std::any_of(rig.cameras.begin(), rig.cameras.end(), [](const RigCamera& camera) { return !camera.source.empty(); });
}

/// A rig that was calibrated over a pitch has one; any other has none unless an option gives it.
void set_area(const GroundAreaFlags& flags, const Rig& rig, pipeline::PeopleOnGroundOptions& options) {
  if (!flags.area.empty()) {
    options.area = parse_area(flags.area);
  } else if (!flags.size.empty()) {
    options.pitch = parse_pitch_or_rectangle(flags.size);
    if (!options.pitch) options.area = parse_area(flags.size);
  } else if (rig.calibration && rig.calibration->method == "pitch") {
    options.pitch.emplace();
  }
}

}  // namespace

void add_ground_area_options(Command& command, const Option& ground, GroundAreaFlags& flags) {
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
      .text("--associate", flags.association,
            "how observations are associated with tracks: gnn, jpda or mht (default: mht; gnn with live cameras or --live, and "
            "for boxes where cameras agree); or bramble, which looks at pictures by particles, without detections")
      .needs(ground)
      .check(track::ground::ground_association_named);
}

void apply(const GroundAreaFlags& flags, const Rig& rig, const std::string& rig_name, bool live,
           pipeline::PeopleOnGroundOptions& options) {
  options.live = live;
  if (!flags.teams.empty()) options.teams.names = analyse::parse_teams(flags.teams);
  options.tracker.associate =
      flags.association.empty() ? default_association(live) : track::ground::ground_association_named(flags.association);
  options.learn.association = flags.association.empty() && !has_pictures(rig);
  set_area(flags, rig, options);
  if (flags.margin && !options.pitch && options.area.empty())
    throw WrongUsage("--margin is counted from the edge of a pitch or an area, and {} tells of none; give its --size or --area",
                     rig_name);
  options.margin = flags.margin.value_or(options.margin);
}

}  // namespace marey::cli

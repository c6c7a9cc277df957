#include "ground_options.h"

#include <utility>

#include "marey/pipeline/people/ground_defaults.h"

#include "pitch_size.h"

namespace marey::cli {
namespace {

void set_area(const GroundAreaFlags& flags, pipeline::people::PeopleOnGroundOptions& options) {
  if (!flags.area.empty()) {
    options.area = parse_area(flags.area);
  } else if (!flags.size.empty()) {
    options.pitch = parse_pitch_or_rectangle(flags.size);
    if (!options.pitch) options.area = parse_area(flags.size);
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

void apply(const GroundAreaFlags& flags, const Rig& rig, const std::string& rig_name, bool live, bool filter_chosen,
           pipeline::people::PeopleOnGroundOptions& options) {
  options.live = live;
  pipeline::people::GroundChoices choices{.filter = filter_chosen};
  if (!flags.association.empty()) choices.association = track::ground::ground_association_named(flags.association);
  set_area(flags, options);
  options = pipeline::people::resolved(std::move(options), rig, choices);
  if (!flags.teams.empty()) options.teams.names = analyse::parse_teams(flags.teams);
  if (flags.margin && !options.pitch && options.area.empty())
    throw WrongUsage("--margin is counted from the edge of a pitch or an area, and {} tells of none; give its --size or --area",
                     rig_name);
  options.margin = flags.margin.value_or(options.margin);
}

}  // namespace marey::cli

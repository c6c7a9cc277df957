#include "marey/pipeline/jobs/track_ground.h"

#include <algorithm>

#include "marey/filter/default_motion.h"
#include "marey/pipeline/jobs/ground_size.h"

namespace marey::pipeline::jobs {
namespace {

using Association = track::ground::GroundAssociation;

constexpr std::string_view kBramble = "bramble";  // no association of observations, but a stage of its own

void check_association(const std::string& name) {
  if (name != kBramble) track::ground::ground_association_named(name);
}

void check_ground(const TrackGround& job) {
  if (job.ground.association == kBramble && (!job.detection.network.empty() || !job.filter.empty() || !job.ground.teams.empty()))
    throw WrongOption("--association bramble has its own likelihood and motion model and no appearance; omit --{}",
                      !job.detection.network.empty() ? "detector"
                      : !job.filter.empty()          ? "filter"
                                                     : "teams");
  if (job.ball && job.options.live)
    throw WrongOption("{}", "--ball needs the whole recording before it reports the ball; omit --live or --ball");
}

/// A margin belongs to the edge of something.
void set_part(const TrackGround& job, const Rig& rig, people::ground::PeopleOnGroundOptions& options) {
  const GroundPart& ground = job.ground;
  if (!ground.area.empty()) {
    options.area = parse_area(ground.area);
  } else if (!ground.size.empty()) {
    options.pitch = parse_pitch_or_rectangle(ground.size);
    if (!options.pitch) options.area = parse_area(ground.size);
  }
  const bool bounded = options.pitch || !options.area.empty();
  if (!bounded && rig.calibration && rig.calibration->method == "pitch") options.pitch.emplace();
  if (ground.margin && !options.pitch && options.area.empty())
    throw WrongOption("--margin is counted from the edge of a pitch or an area, and {} has none; give its --size or --area",
                      job.rig_name);
  options.margin = ground.margin.value_or(options.margin);
}

void set_association(const TrackGround& job, const Rig& rig, people::ground::PeopleOnGroundOptions& options) {
  const bool bramble = job.ground.association == kBramble;
  if (bramble) options.bramble.emplace();
  const bool chosen = !job.ground.association.empty();
  if (chosen && !bramble) {
    options.tracker.associate = track::ground::ground_association_named(job.ground.association);
  } else {
    options.tracker.associate = options.live ? Association::gnn : Association::mht;
  }
  // Compared with decoding and detection, hypotheses cost little; detections alone arrive too fast for them.
  const auto has_images = [](const RigCamera& camera) { return !camera.source.empty(); };
  options.learn.association = !chosen && std::none_of(rig.cameras.begin(), rig.cameras.end(), has_images);
}

}  // namespace

void add_ground_rows(Table& table, GroundPart& ground) {
  table
      .size("size", ground.size,
            "m, of the pitch, or of any other rectangle from the origin on (default: 105x68 if the rig was "
            "calibrated on a pitch, else people count everywhere)")
      .checked(parse_pitch_or_rectangle)
      .needing("ground");
  table
      .corners("area", ground.area,
               "where people count, in place of a pitch: its corners in order, \"x,y x,y x,y\" in m, or LENGTHxWIDTH")
      .checked(parse_area)
      .needing("ground")
      .depending_on({"size"});
  table
      .number("margin", ground.margin, "m", closed(0, 1000),
              "around the pitch or the area in which people still count (default: 2)")
      .needing("ground")
      .depending_on({"size", "area"});
  table.text("teams", ground.teams, "the teams' colours, \"white,blue\", or their names too, \"City=white,United=blue\"")
      .checked(analyse::parse_teams)
      .needing("ground");
  table
      .choice("association", ground.association, {"gnn", "jpda", "mht", std::string(kBramble)},
              "data association (default: mht; gnn with live cameras or --live, and for boxes whose cameras agree); bramble tracks "
              "by particles in the images, without detections")
      .checked(check_association)
      .needing("ground")
      .depending_on({"live", "filter"});
}

Table table_of(TrackGround& job) {
  Table table;
  table.always("ground", "true");
  table.number("rate", job.options.rate_hz, "Hz", kRates, "frame rate, if the file does not specify it or is wrong");
  table.output_folder("overlay", job.output.overlays, "a folder for such a video of each camera, CAMERA.mp4");
  table.choice("blur", job.output.blur, {"faces"},
               "make heads unrecognisable in --overlay and --copy: those of the people who are tracked");
  table.output_folder("copy", job.output.copies, "a folder for the videos with nothing drawn and faces blurred, CAMERA.mp4")
      .needing("blur");
  add_filter_row(table, job.filter);
  table.flag("live", job.options.live, "write each frame's tracks at once; nothing is corrected by later frames");
  table.flag("stabilise", job.options.stabilise,
             "the camera shakes (wind, steps): stabilise its images first; results are in the pixels of its rest");
  table.group("Options for --targets people");
  add_people_rows(table, job.detection);
  add_number_row(table, job.output.numbers);
  table.group("Options for --ground");
  add_ground_rows(table, job.ground);
  table.flag("ball", job.ball, "track the ball too: a track named \"ball\", with its height").needing("ground");
  table
      .output_file("pitch-view", job.output.pitch_view, "a video of the ground from above, with the trail of each person: FILE.mp4")
      .ending_in({".mp4"})
      .needing("ground");
  return table;
}

people::ground::PeopleOnGroundOptions resolved(const TrackGround& job, const Rig& rig) {
  check_ground(job);
  people::ground::PeopleOnGroundOptions options = job.options;
  options.detector = detector_of(job.detection, false, "--ground");
  if (!job.filter.empty()) options.tracker.filter = filter::filter_for_people_on_ground(job.filter);
  if (job.own_filter) options.tracker.filter = *job.own_filter;
  options.learn.walk = job.filter.empty() && !job.own_filter;
  set_part(job, rig, options);
  set_association(job, rig, options);
  if (!job.ground.teams.empty()) options.teams.names = analyse::parse_teams(job.ground.teams);
  if (job.ball) options.ball.emplace();
  return options;
}

}  // namespace marey::pipeline::jobs

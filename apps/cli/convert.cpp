#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/format/motion/motion.h"
#include "marey/format/rig/rig_exchange.h"

#include "command_line.h"
#include "commands.h"
#include "convert_ground.h"
#include "json_value.h"
#include "progress_bar.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

struct ConvertOptions {
  std::string from, to;
  std::string format;
  std::string up, from_up;
  GroundConversion ground;
  bool labelled = false;
  bool json = false;
  bool quiet = false;
};

format::motion::UpAxis axis_of(const std::string& name) {
  return name == "y" ? format::motion::UpAxis::y : format::motion::UpAxis::z;
}

/// `--up` is the axis of B; where B is a take, whose z is up always, it is that of A.
std::pair<format::motion::UpAxis, format::motion::UpAxis> axes(const ConvertOptions& options, format::motion::MotionFormat from,
                                                               format::motion::MotionFormat to) {
  const format::motion::UpAxis up = axis_of(options.up);
  if (!options.from_up.empty()) {
    if (from == format::motion::MotionFormat::take) throw WrongUsage("a take's z is up always; --from-up is for other files");
    return {axis_of(options.from_up), up};
  }
  if (to == format::motion::MotionFormat::take) return {up, format::motion::UpAxis::z};
  return {format::motion::UpAxis::z, up};
}

format::motion::MotionFormat format_to_write(const ConvertOptions& options) {
  if (!options.format.empty()) return format::motion::parse_motion_format(options.format);
  const auto format = format::motion::motion_format_of_name(options.to);
  if (!format)
    throw WrongUsage("{}: its ending is of no format; name one with --format: {}", options.to,
                     format::motion::motion_format_names());
  return *format;
}

format::motion::MotionFormat format_to_read(const ConvertOptions& options) {
  const auto format = fs::is_directory(options.from) ? std::nullopt : format::motion::motion_format_of_content(options.from);
  if (!format) throw Error("{}: is none of the files that Marey reads: {}", options.from, format::motion::motion_format_names());
  return *format;
}

/// `tracks` by id.
void leave_out_others(Instant& instant, const std::vector<TrackName>& tracks) {
  std::erase_if(instant.samples, [&](const Sample& point) {
    const auto by_id = [](const TrackName& track, TrackId id) { return track.id < id; };
    const auto found = std::lower_bound(tracks.begin(), tracks.end(), point.track, by_id);
    return found == tracks.end() || found->id != point.track;
  });
}

/// What was written, for the user.
struct Written {
  std::string format;
  std::int64_t count = 0;
  std::string of;  ///< what is counted, in the plural
};

Written convert_rig(const ConvertOptions& options) {
  const auto by_name = format::rig::rig_format_of_name(options.to);
  if (options.format.empty() && !by_name) {
    throw WrongUsage("{}: its ending is of no format of calibrations; name one with --format: {}", options.to,
                     format::rig::rig_format_names());
  }
  if (!options.up.empty() || !options.from_up.empty()) {
    throw WrongUsage("{}: is a calibration, whose z is up always; --up and --from-up are for points", options.from);
  }
  const auto to = options.format.empty() ? *by_name : format::rig::parse_rig_format(options.format);
  const Rig rig = format::rig::read_rig_any(options.from);
  format::rig::write_rig_as(rig, options.to, to);
  return {"a calibration", static_cast<std::int64_t>(rig.cameras.size()), "cameras"};
}

Written convert_motion(const ConvertOptions& options) {
  const format::motion::MotionFormat from = format_to_read(options), to = format_to_write(options);
  const auto [from_up, to_up] = axes(options, from, to);
  // Read twice: most formats begin with what is known only at the end.
  const auto first = format::motion::open_motion(options.from, from, from_up);
  format::motion::MotionPlan plan = format::motion::plan_of(*first, options.from);
  for (const std::string& sentence : first->warnings()) fmt::print(stderr, "marey: warning: {}\n", sentence);
  // A file that says so itself is still believed only where the user says it too: many say it by mistake.
  if (plan.info.up == format::motion::UpAxis::y && from_up == format::motion::UpAxis::z) {
    fmt::print(stderr, "marey: warning: {}: says that y is up; {} turns it so that z is\n", options.from,
               to == format::motion::MotionFormat::take ? "--up y" : "--from-up y");
  }
  if (options.labelled) std::erase_if(plan.info.tracks, [](const TrackName& track) { return track.label.empty(); });
  const auto reader = format::motion::open_motion(options.from, from, from_up);
  const auto sink = format::motion::create_motion(options.to, to, plan, to_up);
  sink->begin(plan.info.header);
  ProgressBar progress(options.quiet);
  std::int64_t done = 0;
  while (auto instant = reader->next()) {
    if (options.labelled) leave_out_others(*instant, plan.info.tracks);
    if (done == 0) instant->named = plan.info.tracks;
    sink->write(*instant);
    progress.show("converting", ++done, plan.info.frame_count);
  }
  sink->finish();
  return {std::string(format::motion::motion_format_name(to)), done, "frames"};
}

Written convert(const ConvertOptions& options) {
  std::error_code error;
  if (format::match::ground_format_of_content(options.from) || is_take_of_ground(options.from)) {
    if (!options.up.empty() || !options.from_up.empty())
      throw WrongUsage("{}: holds people on the ground; --up and --from-up are for points in space", options.from);
    const GroundWritten written = convert_ground(options.from, options.to, options.format, options.ground);
    return {written.format, written.places, "places"};
  }
  const bool motion = fs::is_regular_file(options.from, error) && format::motion::motion_format_of_content(options.from);
  if (!motion && format::rig::rig_format_of_content(options.from)) return convert_rig(options);
  return convert_motion(options);
}

void run(const ConvertOptions& options) {
  const Written written = convert(options);
  if (options.json) {
    print({{"from", options.from}, {"to", options.to}, {"format", written.format}, {written.of, written.count}});
  } else if (!options.quiet) {
    fmt::print(stderr, "{}: {}, {} {}\n", options.to, written.format, written.count, written.of);
  }
}

void check_format(const std::string& name) {
  const auto is = [&](auto parse) {
    try {
      parse(name);
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  if (!is(format::motion::parse_motion_format) && !is(format::rig::parse_rig_format)) format::match::parse_ground_format(name);
}

/// What is read or written beside a file of people on the ground: Metrica's other half, TRACAB's metadata, EPTS's positions.
std::vector<std::string> beside(const std::string& path) {
  const auto with = [&](std::string_view ending, const char* other) { return path.substr(0, path.size() - ending.size()) + other; };
  if (path.ends_with("_home.csv")) return {with("_home.csv", "_away.csv")};
  if (path.ends_with("_away.csv")) return {with("_away.csv", "_home.csv")};
  if (path.ends_with(".dat")) return {with(".dat", ".xml")};
  if (path.ends_with(".xml")) return {with(".xml", ".txt")};
  return {};
}

}  // namespace

void add_convert(Command& program) {
  auto options = std::make_shared<ConvertOptions>();
  Command command =
      program.subcommand("convert", "Write a recording of points, people on the ground, or a calibration, in another format");
  command
      .input_file("A", options->from,
                  "take, C3D, TRC, CSV (tidy, Motive's, Nexus's), people on the ground, or calibration; known by its content")
      .required();
  command
      .output_file(
          "B", options->to,
          "what to write; its ending names the format: .marey, .c3d, .trc, .csv; of people on the ground .csv, .txt (MOT), "
          "_home.csv (Metrica), .dat (TRACAB), .xml (EPTS), .json (SoccerNet); of a calibration .toml, .yml, .qca.txt, .xml")
      .required();
  command
      .text("--format", options->format,
            "B's format in place of its ending: " + format::motion::motion_format_names() + "; of people on the ground " +
                format::match::ground_format_names() + "; of a calibration " + format::rig::rig_format_names())
      .check(check_format);
  constexpr std::array<std::pair<const char*, const char*>, 2> kAxes{{{"y", "y"}, {"z", "z"}}};
  command.choice("--up", options->up, kAxes,
                 "the axis that is up in B (in A, where B is a take), z where it is left out; coordinates are turned accordingly");
  command.choice("--from-up", options->from_up, kAxes, "the axis that is up in A, z where it is left out");
  command.flag("--labelled", options->labelled, "leave out tracks that have no label");
  add_ground_conversion(command, options->ground);
  command.also_reads([options] { return beside(options->from); });
  command.also_writes([options] { return beside(options->to); });
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

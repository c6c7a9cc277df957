#include "marey/pipeline/take/convert.h"

#include <array>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/edit/request.h"
#include "marey/format/register.h"
#include "marey/format/skeleton/rig_names.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct ConvertCommand {
  std::string from, to;
  std::string size = "105x68", frames;
  std::vector<std::string> periods;
  pipeline::take::ConvertOptions options;
  bool json = false;
  bool quiet = false;
};

/// FIRST-LAST, frames counted from 0.
format::match::GroundPeriod parse_period(const std::string& text, int number) {
  const std::size_t dash = text.find('-', 1);
  const auto first = whole_number_of(std::string_view(text).substr(0, dash));
  const auto last = whole_number_of(dash == std::string::npos ? std::string_view() : std::string_view(text).substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last > 1'000'000'000)
    throw Error("\"{}\" is not a period; give its first and last frame, counted from 0, as 0-67499", text);
  return {number, static_cast<std::int32_t>(*first), static_cast<std::int32_t>(*last)};
}

edit::FrameRange parse_frames(const std::string& text) {
  const auto frames = edit::parse_range(text);
  if (!frames) throw Error("\"{}\" are not frames; write FIRST:LAST, counted from 0, as 120:480, 120: or :480", text);
  return *frames;
}

void run(ConvertCommand& command) {
  command.options.read.pitch = parse_pitch_size(command.size);
  for (const std::string& period : command.periods)
    command.options.periods.push_back(parse_period(period, static_cast<int>(command.options.periods.size()) + 1));
  if (!command.frames.empty()) command.options.frames = parse_frames(command.frames);
  const pipeline::take::ConvertSummary done = with_progress(
      command.quiet, [&](const Hooks& hooks) { return pipeline::take::convert(command.from, command.to, command.options, hooks); });
  warn(done.warnings);
  if (done.stopped) {
    fmt::print(stderr, "marey: stopped; {} was not finished\n", command.to);
    throw EndWith{kInterrupted};
  }
  if (command.json) {
    print({{"from", command.from}, {"to", command.to}, {"format", done.format}, {done.counted, done.count}});
  } else if (!command.quiet) {
    fmt::print(stderr, "{}: {}, {} {}\n", command.to, done.format, done.count, done.counted);
  }
}

/// The files read or written beside a file of a pair.
std::vector<std::string> companion_of(const std::string& path) {
  const std::string other = format::companion_file(path);
  return other.empty() ? std::vector<std::string>{} : std::vector{other};
}

void add_reading_options(Command& command, ConvertCommand& options) {
  pipeline::take::ConvertOptions& how = options.options;
  command.group("A skeleton's motion");
  command.number("--unit", how.read.skeleton_unit_m, "m", above(0, 1000),
                 "one unit of a BVH file that is read, in metres: 0.01 is cm, 0.0254 inches");
  command.number("--amc-rate", how.read.amc_rate_hz, "Hz", kRates, "frames a second of an AMC file, which does not specify");
  command.input_file("--metadata", how.read.metadata,
                     "of TRACAB, EPTS or DFL, and an AMC file's .asf, where it is not beside A under a like name");
  command
      .text("--rig-names", how.rig_names,
            fmt::format("whose bones B has (.bvh, .glb): {}; omitted: the skeleton's own", format::skeleton::rig_scheme_names()))
      .check([](const std::string& name) { format::skeleton::rig_scheme(name); });
  command.group("People on the ground");
  command.text("--size", options.size, "of the pitch, LENGTHxWIDTH in m, where A does not specify").check(parse_pitch_size);
  command.number("--rate", how.read.rate_hz, "Hz", kRates, "frames a second, where A does not specify");
  command.text("--home", how.home, "the team that is at home; else of the two largest the one whose people come first");
  command.text("--away", how.away, "the guests");
  command.texts("--period", options.periods, "first and last frame of a half, counted from 0, as 0-67499; once for each")
      .check([](const std::string& text) { parse_period(text, 1); });
  const Option y_down =
      command.flag("--y-down", how.frame.y_down, "y of CSV and MOT grows downwards, seen from above with x to the right");
  command.flag("--centred", how.frame.centred, "CSV and MOT count from the middle of the pitch, not from a corner");
  command
      .input_file(
          "--rig", how.rig,
          "rig whose ground_from_world says whether --y-down is so; of points in space: the cameras of a scene for Blender (.py)")
      .excludes(y_down);
  command.group("");
}

}  // namespace

void add_convert(Command& program) {
  auto options = std::make_shared<ConvertCommand>();
  pipeline::take::ConvertOptions& how = options->options;
  using format::Content;
  Command command = program.subcommand("convert", "Write a recording, or a calibration, in another format");
  command
      .input_file(
          "A", options->from,
          "a recording or a calibration, known by its content: " + format::names_of_read(format::kRecordings | Content::rig))
      .required();
  command
      .output_file(
          "B", options->to,
          fmt::format("what to write; its ending names the format. Points in space: {}; people on the ground: {}; tracks in a "
                      "image: {}; calibrations: {}",
                      format::endings_of_written(Content::space), format::endings_of_written(Content::ground),
                      format::endings_of_written(Content::image), format::endings_of_written(Content::rig)))
      .required();
  command.text("--format", how.format, "B's format in place of its ending, by the names above").check(format::check_written_name);
  using Axis = std::optional<format::UpAxis>;
  constexpr std::array<std::pair<const char*, Axis>, 2> kAxes{{{"y", format::UpAxis::y}, {"z", format::UpAxis::z}}};
  command.choice("--up", how.up, kAxes,
                 "the axis that is up in B, z where it is omitted (in A, where B is a take); coordinates are turned accordingly");
  command.choice("--from-up", how.from_up, kAxes,
                 "the axis that is up in A; as A says where it is omitted, else z; y of a skeleton's motion (.bvh, .asf)");
  command.flag("--without-edits", how.read.as_recorded, "of a take: without what was edited afterwards");
  command
      .text("--frames", options->frames,
            "FIRST:LAST, counted from 0, both included: these alone, with their numbers and times as they were")
      .check(parse_frames);
  command.flag("--labelled-only", how.labelled, "omit tracks that have no label");
  command.input_file("--analog", how.analog,
                     "a C3D file whose analog channels, force plates and events go along into B, a C3D file too: the one that A, a "
                     "take, was made of");
  add_reading_options(command, *options);
  command.also_reads([options] { return companion_of(options->from); });
  command.also_writes([options] { return companion_of(options->to); });
  command.reports(options->json, options->quiet);
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

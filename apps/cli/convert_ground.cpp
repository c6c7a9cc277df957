#include "convert_ground.h"

#include <cstdio>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/take_file.h"

#include "command_line.h"
#include "pitch_size.h"

namespace marey::cli {
namespace {

/// FIRST-LAST, frames counted from 0.
format::match::GroundPeriod parse_period(const std::string& text, int number) {
  const std::size_t dash = text.find('-', 1);
  const auto first = whole_number_of(std::string_view(text).substr(0, dash));
  const auto last = dash == std::string::npos ? std::nullopt : whole_number_of(std::string_view(text).substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last > 1'000'000'000)
    throw Error("\"{}\" is no period; give its first and last frame, counted from 0, as 0-67499", text);
  return {number, static_cast<std::int32_t>(*first), static_cast<std::int32_t>(*last)};
}

format::match::GroundFrame frame_of(const GroundConversion& options) {
  format::match::GroundFrame frame{options.y_down, options.centred};
  if (options.rig.empty()) return frame;
  const Rig rig = format::rig::read_rig(options.rig);
  if (!rig.ground_from_world)
    throw Error("{}: says nothing of the ground; `marey calibrate pitch` makes a rig that does", options.rig);
  // A reflection: seen from above, y grows to the right of x, downwards.
  frame.y_down = rig.ground_from_world->topLeftCorner<2, 2>().determinant() < 0;
  return frame;
}

/// Whether coordinates are the user's; else they are the pitch's.
bool is_plain(format::match::GroundFormat format) {
  return format == format::match::GroundFormat::csv || format == format::match::GroundFormat::mot;
}

}  // namespace

void add_ground_conversion(Command& command, GroundConversion& options) {
  command.group("People on the ground");
  command.input_file("--metadata", options.metadata, "of TRACAB, EPTS or DFL, where it is not beside A under a like name");
  command.text("--size", options.size, "of the pitch, LENGTHxWIDTH in m, where A does not say").check(parse_pitch_size);
  command.number("--rate", options.rate_hz, "Hz", kRates, "frames a second, where A does not say");
  command.text("--home", options.home, "the team that is at home; else of the two largest the one whose people come first");
  command.text("--away", options.away, "the guests");
  command.texts("--period", options.periods, "first and last frame of a half, counted from 0, as 0-67499; once for each")
      .check([](const std::string& text) { parse_period(text, 1); });
  const Option y_down =
      command.flag("--y-down", options.y_down, "y of CSV and MOT grows downwards, seen from above with x to the right");
  command.flag("--centred", options.centred, "CSV and MOT count from the middle of the pitch, not from a corner");
  command.input_file("--rig", options.rig, "rig whose ground_from_world says whether --y-down is so").excludes(y_down);
  command.group("");
}

bool is_take_of_ground(const std::string& path) {
  if (!format::take::is_take(path)) return false;
  const FrameOfReference frame = format::take::TakeReader(path).header().frame;
  return frame.metric() && frame.dimensions() == 2;
}

GroundWritten convert_ground(const std::string& from, const std::string& to, const std::string& format_name,
                             const GroundConversion& options) {
  const auto by_name = format::match::ground_format_of_name(to);
  if (format_name.empty() && !by_name)
    throw WrongUsage("{}: its ending is of no format of people on the ground; name one with --format: {}", to,
                     format::match::ground_format_names());
  // "csv" is a name of points' formats, and what everyone will try.
  const format::match::GroundFormat out = format_name.empty()    ? *by_name
                                          : format_name == "csv" ? format::match::GroundFormat::csv
                                                                 : format::match::parse_ground_format(format_name);
  const format::match::GroundFrame frame = frame_of(options);
  const auto in = format::match::ground_format_of_content(from).value_or(format::match::GroundFormat::csv);
  const format::match::GroundReadOptions how{options.metadata, parse_pitch_size(options.size), options.rate_hz};
  format::match::GroundMatch match =
      is_take_of_ground(from) ? format::match::read_ground_any(from, how) : format::match::read_ground_as(from, in, how);
  if (!options.home.empty()) match.home = options.home;
  if (!options.away.empty()) match.away = options.away;
  if (!options.periods.empty()) match.periods.clear();
  for (const std::string& period : options.periods)
    match.periods.push_back(parse_period(period, static_cast<int>(match.periods.size()) + 1));
  if (is_plain(in) && !is_plain(out)) match.recording = format::match::to_corner(std::move(match.recording), match.pitch, frame);
  if (!is_plain(in) && is_plain(out)) match.recording = format::match::from_corner(std::move(match.recording), match.pitch, frame);
  std::vector<std::string> warnings = match.warnings;
  const std::vector<std::string> lost = format::match::write_ground_as(match, to, out);
  warnings.insert(warnings.end(), lost.begin(), lost.end());
  for (const std::string& sentence : warnings) fmt::print(stderr, "marey: warning: {}\n", sentence);
  return {std::string(format::match::ground_format_name(out)), match.recording.samples()};
}

}  // namespace marey::cli

#include "convert_ground.h"

#include <cstdio>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/text_rows.h"

#include "known.h"
#include "pitch_size.h"

namespace marey::cli {
namespace {

/// FIRST-LAST, frames counted from 0.
format::match::GroundPeriod parse_period(const std::string& text, int number) {
  const std::size_t dash = text.find('-', 1);
  const auto first = format::whole_number_of(std::string_view(text).substr(0, dash));
  const auto last = dash == std::string::npos ? std::nullopt : format::whole_number_of(std::string_view(text).substr(dash + 1));
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

void add_ground_conversion(CLI::App& command, GroundConversion& options) {
  const auto group = "People on the ground";
  command.add_option("--metadata", options.metadata, "of TRACAB, EPTS or DFL, where it is not beside A under a like name")
      ->group(group);
  command.add_option("--size", options.size, "of the pitch, LENGTHxWIDTH in m, where A does not tell")
      ->check(known([](const std::string& text) { parse_pitch_size(text); }))
      ->capture_default_str()
      ->group(group);
  command.add_option("--rate", options.rate_hz, "frames a second, where A does not tell")
      ->check(CLI::Range(0.1, 10'000.0))
      ->capture_default_str()
      ->group(group);
  command.add_option("--home", options.home, "the team that is at home; else of the two largest the one whose people come first")
      ->group(group);
  command.add_option("--away", options.away, "the guests")->group(group);
  command.add_option("--period", options.periods, "first and last frame of a half, counted from 0, as 0-67499; once for each")
      ->check(known([](const std::string& text) { parse_period(text, 1); }))
      ->group(group);
  CLI::Option* y_down =
      command.add_flag("--y-down", options.y_down, "y of CSV and MOT grows downwards, seen from above with x to the right")
          ->group(group);
  command.add_flag("--centred", options.centred, "CSV and MOT count from the middle of the pitch, not from a corner")->group(group);
  command.add_option("--rig", options.rig, "rig whose ground_from_world tells whether --y-down is so")
      ->excludes(y_down)
      ->group(group);
}

void convert_ground(const std::string& from, const std::string& to, const std::string& format_name,
                    const GroundConversion& options) {
  const auto by_name = format::match::ground_format_of_name(to);
  if (format_name.empty() && !by_name)
    throw Error("{}: its ending is of no format of people on the ground; name one with --format: {}", to,
                format::match::ground_format_names());
  // "csv" is a name of points' formats, and what everyone will try.
  const format::match::GroundFormat out = format_name.empty()    ? *by_name
                                          : format_name == "csv" ? format::match::GroundFormat::csv
                                                                 : format::match::parse_ground_format(format_name);
  const format::match::GroundFrame frame = frame_of(options);
  const auto in = format::match::ground_format_of_content(from).value_or(format::match::GroundFormat::csv);
  format::match::GroundMatch match =
      format::match::read_ground_as(from, in, {options.metadata, parse_pitch_size(options.size), options.rate_hz});
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
}

}  // namespace marey::cli

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/pipeline/take/ground_orientation.h"
#include "marey/pipeline/take/measure_contours.h"
#include "marey/pipeline/take/measure_match.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_size.h"
#include "run_hooks.h"

namespace marey::cli {
namespace {

struct MeasureCommand {
  std::string tracks;
  pipeline::take::MeasureOutput output;
  std::string series;
  std::string method = "lowpass", zones = "2,4,5.5,7", size = "105x68", rig;
  bool y_down = false;
  pipeline::take::MeasureMatchOptions options;
  bool json = false;
  bool quiet = false;
};

std::vector<double> parse_zones(const std::string& text) {
  constexpr const char* form = "growing speeds in m/s, as 2,4,5.5,7";
  std::vector<double> zones = numbers_in(text, ',', above(0, 100), form);
  if (std::adjacent_find(zones.begin(), zones.end(), std::greater_equal<>()) != zones.end())
    throw WrongUsage("{}: the speeds do not grow; write {}", text, form);
  return zones;
}

Json ball_json(const analyse::BallMeasure& ball) {
  Json teams = Json::array(), passes = Json::array(), spells = Json::array();
  for (const analyse::TeamBall& team : ball.teams)
    teams.push_back(
        {{"team", team.team}, {"possession_s", team.possession_s}, {"passes", team.passes}, {"completed", team.completed}});
  for (const analyse::BallPass& pass : ball.passes)
    passes.push_back({{"from", pass.from},
                      {"to", pass.to},
                      {"team", pass.team},
                      {"begin_s", pass.begin_s},
                      {"end_s", pass.end_s},
                      {"length_m", pass.length_m},
                      {"completed", pass.completed}});
  for (const analyse::BallSpell& spell : ball.spells)
    spells.push_back({{"id", spell.person}, {"team", spell.team}, {"begin_s", spell.begin_s}, {"end_s", spell.end_s}});
  return {{"seconds", ball.seconds}, {"dead_s", ball.dead_s}, {"distance_m", ball.distance_m}, {"max_mps", ball.top_mps},
          {"teams", teams},          {"passes", passes},      {"possession", spells}};
}

Json json_or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json impossible_json(const std::vector<analyse::ImpossibleSegment>& segments) {
  Json all = Json::array();
  for (const analyse::ImpossibleSegment& one : segments)
    all.push_back({{"begin_s", one.begin_s}, {"end_s", one.end_s}, {"one_person", one.one_person}});
  return all;
}

void report_json(const analyse::Measurement& measured) {
  Json people = Json::array(), teams = Json::array();
  for (const analyse::PersonMeasure& person : measured.people) {
    people.push_back({{"id", person.id},
                      {"label", person.label},
                      {"team", person.team},
                      {"seconds", person.seconds},
                      {"distance_m", person.distance_m},
                      {"mean_mps", person.mean_mps},
                      {"max_mps", json_or_null(person.top_mps)},
                      {"top_sigma_mps", json_or_null(person.top_sigma_mps)},
                      {"seen_s", person.observed_s},
                      {"impossible", impossible_json(person.impossible)},
                      {"sprints", person.sprints},
                      {"accelerations", person.accelerations},
                      {"decelerations", person.decelerations},
                      {"zone_s", person.zone_s},
                      {"zone_m", person.zone_m}});
  }
  for (const analyse::TeamMeasure& team : measured.teams) {
    teams.push_back({{"team", team.team},
                     {"people", team.people},
                     {"distance_m", team.distance_m},
                     {"length_m", team.length_m},
                     {"width_m", team.width_m},
                     {"hull_m2", team.hull_m2}});
  }
  Json all{{"people", people}, {"teams", teams}};
  if (measured.ball) all["ball"] = ball_json(*measured.ball);
  print(all);
}

/// What was not trusted, so that it can be inspected.
void print_impossible(const analyse::Measurement& measured) {
  constexpr std::size_t maximum = 10;
  std::size_t reported = 0;
  for (const analyse::PersonMeasure& person : measured.people) {
    for (const analyse::ImpossibleSegment& one : person.impossible) {
      if (++reported > maximum) continue;
      fmt::print("not counted: #{} from {:.1f} s to {:.1f} s, for no person moves like that; {}\n", person.id, one.begin_s,
                 one.end_s, one.one_person ? "the places are wrong" : "who is there before and after are two people");
    }
  }
  if (reported > maximum) fmt::print("not counted: {} more such stretches (--json lists all)\n", reported - maximum);
}

std::string shown_speed(const std::optional<double>& value) {
  return value ? fmt::format("{:.2f}", *value) : std::string("-");
}

void print_table(const analyse::Measurement& measured) {
  fmt::print("{:>5} {:<12} {:<10} {:>11} {:>10} {:>9} {:>6} {:>8}\n", "id", "label", "team", "distance, m", "mean, m/s", "top, m/s",
             "±", "sprints");
  for (const analyse::PersonMeasure& person : measured.people) {
    fmt::print("{:>5} {:<12} {:<10} {:>11.1f} {:>10.2f} {:>9} {:>6} {:>8}\n", person.id, person.label, person.team,
               person.distance_m, person.mean_mps, shown_speed(person.top_mps), shown_speed(person.top_sigma_mps), person.sprints);
  }
  print_impossible(measured);
  if (!measured.ball) return;
  for (const analyse::TeamBall& team : measured.ball->teams)
    fmt::print("ball: {} has it {:.1f} s, passes {}, {} of them to the own team\n", team.team, team.possession_s, team.passes,
               team.completed);
  fmt::print("ball: known for {:.1f} s, {:.1f} s of them off the pitch\n", measured.ball->seconds, measured.ball->dead_s);
}

std::string report_file(const MeasureCommand& command) {
  return (std::filesystem::path(command.output.report) / "report.html").string();
}

Json contour_json(const pipeline::take::ContourFigure& figure) {
  if (figure.samples == 0) return nullptr;
  return {{"mean", figure.mean}, {"sd", figure.spread}, {"sigma", figure.deviation}};
}

void report_contours_json(const pipeline::take::ContourMeasurement& measured) {
  Json people = Json::array();
  for (const pipeline::take::PersonContours& person : measured.people) {
    people.push_back({{"id", person.id},
                      {"label", person.label},
                      {"contours", person.contours},
                      {"measured", person.area.samples},
                      {"area", contour_json(person.area)},
                      {"width", contour_json(person.width)},
                      {"height", contour_json(person.height)},
                      {"lean_deg", contour_json(person.lean)},
                      {"leg_opening", contour_json(person.leg_opening)}});
  }
  print(Json{{"people", people}, {"unit", measured.metric ? "m" : "px"}});
}

void print_contours(const pipeline::take::ContourMeasurement& measured) {
  const char* unit = measured.metric ? "m" : "px";
  const auto shown = [](const pipeline::take::ContourFigure& figure) {
    return figure.samples > 0 ? fmt::format("{:.3g} ± {:.2g}", figure.mean, figure.deviation) : std::string("-");
  };
  fmt::print("{:>5} {:<12} {:>9} {:>16} {:>15} {:>15} {:>13} {:>15}\n", "id", "label", "contours", fmt::format("area, {}²", unit),
             fmt::format("width, {}", unit), fmt::format("height, {}", unit), "lean, °", fmt::format("legs, {}", unit));
  for (const pipeline::take::PersonContours& person : measured.people) {
    fmt::print("{:>5} {:<12} {:>9} {:>15} {:>15} {:>15} {:>13} {:>15}\n", person.id, person.label, person.contours,
               shown(person.area), shown(person.width), shown(person.height), shown(person.lean), shown(person.leg_opening));
  }
}

/// Of tracks in an image: what their contours say.
void run_contours(const MeasureCommand& command) {
  if (!command.output.report.empty()) throw WrongUsage("--report is of people on the ground; {} is of an image", command.tracks);
  const pipeline::take::MeasureContoursOptions options{.rig = command.rig, .series = command.series};
  const auto measured = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::take::measure_contours(command.tracks, command.output.figures, options, hooks);
  });
  if (command.json) {
    report_contours_json(measured);
  } else if (!command.quiet) {
    print_contours(measured);
  }
}

void run(const MeasureCommand& command) {
  if (pipeline::take::is_of_image(command.tracks)) return run_contours(command);
  if (!command.series.empty()) throw WrongUsage("--series is of contours, and {} has none", command.tracks);
  pipeline::take::MeasureMatchOptions options = command.options;
  options.how.path.method = analyse::parse_path_method(command.method);
  options.how.zones = parse_zones(command.zones);
  options.how.pitch = parse_pitch_size(command.size);
  if (command.y_down) options.y_down = true;
  if (!command.rig.empty()) options.y_down = pipeline::take::rig_has_y_down(command.rig);
  const auto [measured, warnings] = with_progress(command.quiet, [&](const Hooks& hooks) {
    return pipeline::take::measure_match(command.tracks, command.output, options, hooks);
  });
  warn(warnings);
  if (command.json) {
    report_json(measured);
  } else if (!command.quiet) {
    print_table(measured);
    if (!command.output.report.empty()) fmt::print("report: {}\n", report_file(command));
  }
}

}  // namespace

void add_measure(Command& program) {
  auto options = std::make_shared<MeasureCommand>();
  Command command = program.subcommand(
      "measure", "How far and how fast every person ran, from places on the ground; or how large bodies are, from contours");
  command
      .input_file("TRACKS", options->tracks,
                  "CSV of `marey track --ground`, or of another tool: frame,time,id,x,y; or TRACAB, EPTS, Metrica, ...: see marey "
                  "convert; or a "
                  "take with contours")
      .required();
  command.output_file("-o,--output", options->output.figures, "CSV with a row for each person").required().ends_in({".csv"});
  command.output_file("--series", options->series, "of contours: CSV with a row for each person and instant").ends_in({".csv"});
  command.output_folder("--report", options->output.report, "folder for a page with plots, tables, heat maps and paths");
  command.text("--smoothing", options->method, "of the paths: lowpass, savgol, kalman or raw").check(analyse::parse_path_method);
  command.number("--cutoff", options->options.how.path.cutoff_hz, "Hz", closed(0.01, 100), "of lowpass");
  command.text("--zones", options->zones, "borders between speed zones, m/s").check(parse_zones);
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  command.input_file("--metadata", options->options.metadata,
                     "of TRACAB, EPTS or DFL, where it is not beside TRACKS under a like name");
  command.number("--rate", options->options.rate_hz, "Hz", kRates, "frames a second, where TRACKS does not specify");
  const Option y_down =
      command.flag("--y-down", options->y_down,
                   "y grows downwards, seen from above with x to the right, where TRACKS does not specify; for the page");
  command
      .input_file(
          "--rig", options->rig,
          "rig whose ground_from_world says whether --y-down is so; of contours, the calibrated camera that took them, for metres")
      .excludes(y_down);
  command.also_writes([options] {
    if (options->output.report.empty()) return std::vector<std::string>{};
    return std::vector{report_file(*options)};
  });
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/pipeline/measure_match.h"

#include "command_line.h"
#include "commands.h"
#include "json_value.h"
#include "pitch_size.h"

namespace marey::cli {
namespace {

struct MeasureCommand {
  std::string tracks, out, report;
  std::string method = "lowpass", zones = "2,4,5.5,7", size = "105x68";
  analyse::MeasureOptions options;
  std::string metadata;
  double rate_hz = 25;
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

void report_json(const analyse::Measurement& measured) {
  Json people = Json::array(), teams = Json::array();
  for (const analyse::PersonMeasure& person : measured.people) {
    people.push_back({{"id", person.id},
                      {"label", person.label},
                      {"team", person.team},
                      {"seconds", person.seconds},
                      {"distance_m", person.distance_m},
                      {"mean_mps", person.mean_mps},
                      {"top_mps", person.top_mps},
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
  print({{"people", people}, {"teams", teams}});
}

void print_table(const analyse::Measurement& measured) {
  fmt::print("{:>5} {:<12} {:<10} {:>11} {:>10} {:>9} {:>8}\n", "id", "label", "team", "distance, m", "mean, m/s", "top, m/s",
             "sprints");
  for (const analyse::PersonMeasure& person : measured.people) {
    fmt::print("{:>5} {:<12} {:<10} {:>11.1f} {:>10.2f} {:>9.2f} {:>8}\n", person.id, person.label, person.team, person.distance_m,
               person.mean_mps, person.top_mps, person.sprints);
  }
}

void run(const MeasureCommand& command) {
  analyse::MeasureOptions options = command.options;
  options.path.method = analyse::parse_path_method(command.method);
  options.zones = parse_zones(command.zones);
  options.pitch = parse_pitch_size(command.size);
  const analyse::Measurement measured =
      analyse::measure(format::read_match(command.tracks, {command.metadata, options.pitch, command.rate_hz}).recording, options);
  if (measured.people.empty()) throw Error("{}: nobody is in it for long enough to be measured", command.tracks);
  WholeFile file(command.out);
  file.write(pipeline::measurement_csv(measured, options));
  if (!command.report.empty())
    pipeline::write_report(measured, options, std::filesystem::path(command.tracks).stem().string(), command.report);
  file.finish();
  if (command.json) {
    report_json(measured);
  } else if (!command.quiet) {
    print_table(measured);
    if (!command.report.empty()) fmt::print("report: {}\n", (std::filesystem::path(command.report) / "report.html").string());
  }
}

}  // namespace

void add_measure(Command& program) {
  auto options = std::make_shared<MeasureCommand>();
  Command command = program.subcommand("measure", "How far and how fast everyone ran, from places on the ground");
  command
      .input_file(
          "TRACKS", options->tracks,
          "CSV of `marey track --ground`, or of another tool: frame,time,id,x,y; or TRACAB, EPTS, Metrica, ...: see marey convert")
      .required();
  command.output_file("-o,--output", options->out, "CSV with a row for each person").required().ends_in({".csv"});
  command.output_folder("--report", options->report, "folder for a page with plots, tables, heat maps and paths");
  command.text("--smoothing", options->method, "of the paths: lowpass, savgol, kalman or raw").check(analyse::parse_path_method);
  command.number("--cutoff", options->options.path.cutoff_hz, "Hz", closed(0.01, 100), "of lowpass");
  command.text("--zones", options->zones, "borders between speed zones, m/s").check(parse_zones);
  command.text("--size", options->size, "of the pitch, LENGTHxWIDTH in m").check(parse_pitch_size);
  command.input_file("--metadata", options->metadata, "of TRACAB, EPTS or DFL, where it is not beside TRACKS under a like name");
  command.number("--rate", options->rate_hz, "Hz", kRates, "frames a second, where TRACKS does not say");
  command.also_writes([options] {
    if (options->report.empty()) return std::vector<std::string>{};
    return std::vector{(std::filesystem::path(options->report) / "report.html").string()};
  });
  command.reports(options->json, options->quiet, "figures");
  command.runs([options] { run(*options); });
}

}  // namespace marey::cli

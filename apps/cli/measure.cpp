#include <charconv>
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/whole_file.h"
#include "marey/format/match/ground_exchange.h"
#include "marey/pipeline/measure_match.h"

#include "commands.h"
#include "known.h"
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
  std::vector<double> zones;
  for (const char *at = text.data(), *end = at + text.size(); at < end;) {
    double value = 0;
    const auto [stop, failed] = std::from_chars(at, end, value);
    if (failed != std::errc() || (stop != end && *stop != ',') || !(value > (zones.empty() ? 0 : zones.back())))
      throw Error("\"{}\" are no speed zones; give growing speeds in m/s, as 2,4,5.5,7", text);
    zones.push_back(value);
    at = stop + 1;
  }
  return zones;
}

void print_json(const analyse::Measurement& measured) {
  nlohmann::json people = nlohmann::json::array(), teams = nlohmann::json::array();
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
  fmt::print("{}\n", nlohmann::json{{"people", people}, {"teams", teams}}.dump(2));
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
  const analyse::Measurement measured = analyse::measure(
      format::match::read_ground_any(command.tracks, {command.metadata, options.pitch, command.rate_hz}).recording, options);
  if (measured.people.empty()) throw Error("{}: nobody is in it for long enough to be measured", command.tracks);
  WholeFile file(command.out);
  file.write(pipeline::measurement_csv(measured, options));
  if (!command.report.empty())
    pipeline::write_report(measured, options, std::filesystem::path(command.tracks).stem().string(), command.report);
  file.finish();
  if (command.json) {
    print_json(measured);
  } else if (!command.quiet) {
    print_table(measured);
    if (!command.report.empty()) fmt::print("report: {}\n", (std::filesystem::path(command.report) / "report.html").string());
  }
}

}  // namespace

void add_measure(CLI::App& app) {
  auto options = std::make_shared<MeasureCommand>();
  CLI::App* command = app.add_subcommand("measure", "How far and how fast everyone ran, from places on the ground");
  command
      ->add_option(
          "TRACKS", options->tracks,
          "CSV of `marey track --ground`, or of another tool: frame,time,id,x,y; or TRACAB, EPTS, Metrica, ...: see marey convert")
      ->required();
  command->add_option("-o,--output", options->out, "CSV with a row for each person")->required();
  command->add_option("--report", options->report, "folder for a page with plots, tables, heat maps and ways");
  command->add_option("--smoothing", options->method, "of the ways: lowpass, savgol, kalman or raw")
      ->check(known([](const std::string& text) { analyse::parse_path_method(text); }))
      ->capture_default_str();
  command->add_option("--cutoff", options->options.path.cutoff_hz, "of lowpass, Hz")
      ->check(CLI::Range(0.01, 100.0))
      ->capture_default_str();
  command->add_option("--zones", options->zones, "borders between speed zones, m/s")
      ->check(known([](const std::string& text) { parse_zones(text); }))
      ->capture_default_str();
  command->add_option("--size", options->size, "of the pitch, LENGTHxWIDTH in m")
      ->check(known([](const std::string& text) { parse_pitch_size(text); }))
      ->capture_default_str();
  command->add_option("--metadata", options->metadata, "of TRACAB, EPTS or DFL, where it is not beside TRACKS under a like name");
  command->add_option("--rate", options->rate_hz, "frames a second, where TRACKS does not tell")
      ->check(CLI::Range(0.1, 10'000.0))
      ->capture_default_str();
  command->add_flag("--json", options->json, "print the figures as JSON");
  command->add_flag("-q,--quiet", options->quiet, "print nothing");
  command->callback([options] { run(*options); });
}

}  // namespace marey::cli

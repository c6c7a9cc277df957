#include "marey/pipeline/take/measure_match.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "marey/analyse/colour_names.h"
#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/draw/match_report.h"
#include "marey/files/whole_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/text_rows.h"
#include "marey/pipeline/take/ground_orientation.h"

namespace marey::pipeline::take {
namespace {

/// "2-4" for the zone between two borders, "over 7" for the last.
std::string zone_name(const std::vector<double>& borders, std::size_t zone) {
  if (zone == borders.size()) return borders.empty() ? "any" : fmt::format("over {:g}", borders.back());
  return fmt::format("{:g}-{:g}", zone == 0 ? 0.0 : borders[zone - 1], borders[zone]);
}

/// Empty if it is not known.
std::string shown_if_known(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : std::string();
}

/// Teams that are called by the colour of their shirts are drawn in it.
std::optional<Appearance> shirt_of(const std::string& team) {
  try {
    return analyse::colour_named(team);
  } catch (const Error&) {
    return std::nullopt;
  }
}

draw::MatchReport::Person page_of(const analyse::PersonMeasure& person) {
  draw::MatchReport::Person page;
  page.number = person.id;
  page.sprints = person.sprint_times;
  page.name = person.label;
  page.team = person.team;
  page.appearance = shirt_of(person.team);
  page.cells = {fmt::format("{:.0f}", person.distance_m), fmt::format("{:.2f}", person.mean_mps),
                shown_if_known(person.top_mps, 1),        shown_if_known(person.top_sigma_mps, 1),
                std::to_string(person.sprints),           std::to_string(person.accelerations),
                std::to_string(person.decelerations),     fmt::format("{:.0f}", person.observed_s)};
  for (const double metres : person.zone_m) page.cells.push_back(fmt::format("{:.0f}", metres));
  for (const analyse::Path& path : person.paths) {
    page.paths.push_back(path.location);
    page.detected.push_back(path.detected);
    auto& speeds = page.speeds.emplace_back();
    for (std::size_t i = 0; i < path.velocity.size(); ++i)
      speeds.emplace_back(path.start_s + path.step_s * static_cast<double>(i), path.velocity[i].norm());
  }
  page.heat_columns = person.heat.columns, page.heat_rows = person.heat.rows, page.heat_cell_m = person.heat.cell_m;
  page.heat = person.heat.seconds;
  return page;
}

std::string measurement_csv(const analyse::Measurement& measured, const analyse::MeasureOptions& options) {
  std::string text =
      "id,label,team,distance_m,mean_mps,top_mps,sprints,seconds,accelerations,decelerations,mean_x,mean_y,"
      "top_sigma_mps,seen_s,impossible";
  for (const char* unit : {"s", "m"}) {
    for (std::size_t zone = 0; zone <= options.zones.size(); ++zone)
      text += fmt::format(",{}_at_{}_mps", unit, zone_name(options.zones, zone));
  }
  text += '\n';
  for (const analyse::PersonMeasure& person : measured.people) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{:.2f},{:.3f},{},{},{:.2f},{},{},{:.2f},{:.2f},{},{:.2f},{}", person.id,
                   format::quoted_field(person.label), format::quoted_field(person.team), person.distance_m, person.mean_mps,
                   shown_if_known(person.top_mps, 3), person.sprints, person.seconds, person.accelerations, person.decelerations,
                   person.average_position.x(), person.average_position.y(), shown_if_known(person.top_sigma_mps, 3),
                   person.observed_s, person.impossible.size());
    for (const auto* zones : {&person.zone_s, &person.zone_m}) {
      for (const double value : *zones) fmt::format_to(std::back_inserter(text), ",{:.2f}", value);
    }
    text += '\n';
  }
  return text;
}

void add_impossible(const analyse::Measurement& measured, draw::MatchReport& report) {
  draw::PageTable table;
  table.title = "Not counted: no person moves like that";
  table.head = {"no.", "name", "from, s", "to, s", "what is wrong"};
  table.bars_from = 5;
  for (const analyse::PersonMeasure& person : measured.people) {
    for (const analyse::ImpossibleSegment& segment : person.impossible)
      table.rows.push_back({std::to_string(person.id), person.label, fmt::format("{:.1f}", segment.begin_s),
                            fmt::format("{:.1f}", segment.end_s),
                            segment.one_person ? "the places" : "the number: before and after are two people"});
  }
  if (!table.rows.empty()) report.tables.push_back(std::move(table));
}

/// The halves, as the file specifies them.
std::vector<draw::MatchReport::Period> periods_of(const format::match::GroundMatch& match) {
  std::vector<draw::MatchReport::Period> periods;
  const auto time_of = [&](std::int32_t frame) {
    const auto& instants = match.recording.instants();
    const auto at = std::lower_bound(instants.begin(), instants.end(), frame,
                                     [](const auto& time_step, auto index) { return time_step.index < index; });
    return instants.empty() ? 0.0 : seconds((at == instants.end() ? instants.back() : *at).time);
  };
  for (const format::match::GroundPeriod& period : match.periods)
    periods.push_back({fmt::format("half {}", period.number), time_of(period.first_frame), time_of(period.last_frame)});
  return periods;
}

void add_ball_tables(const analyse::BallMeasure& ball, draw::MatchReport& report) {
  if (ball.seconds <= 0) return;
  report.tables.push_back({.title = "The ball",
                           .head = {"known for, s", "of them off the pitch, s", "distance, m", "top, m/s"},
                           .rows = {{fmt::format("{:.1f}", ball.seconds), fmt::format("{:.1f}", ball.dead_s),
                                     fmt::format("{:.0f}", ball.distance_m), fmt::format("{:.1f}", ball.top_mps)}}});
  const auto plays = [](const analyse::TeamBall& team) { return team.possession_s > 0 || team.passes > 0; };
  if (std::none_of(ball.teams.begin(), ball.teams.end(), plays)) return;
  draw::PageTable& teams = report.tables.emplace_back();
  teams.title = "Possession";
  teams.head = {"team", "possession, s", "passes", "to the own team"};
  teams.bars_from = 1;
  for (const analyse::TeamBall& team : ball.teams)
    teams.rows.push_back(
        {team.team, fmt::format("{:.1f}", team.possession_s), std::to_string(team.passes), std::to_string(team.completed)});
  if (ball.passes.empty()) return;
  draw::PageTable& passes = report.tables.emplace_back();
  passes.title = "Passes";
  passes.head = {"at, s", "team", "from", "to", "length, m", "took, s"};
  passes.bars_from = 4, passes.folded = true;
  for (const analyse::BallPass& pass : ball.passes)
    passes.rows.push_back({fmt::format("{:.1f}", pass.begin_s), pass.team, std::to_string(pass.from), std::to_string(pass.to),
                           fmt::format("{:.1f}", pass.length_m), fmt::format("{:.1f}", pass.end_s - pass.begin_s)});
}

void add_team_table(const std::vector<analyse::TeamMeasure>& teams, draw::MatchReport& report) {
  draw::PageTable& table = report.tables.emplace_back();
  table.title = "Teams";
  table.bars_from = 2, table.bars_end = 6;
  table.head = {"team", "people", "distance, m", "length", "width", "hull, m²", "x", "y"};
  table.groups = {"", "", "", "how it stands, m", "how it stands, m", "how it stands, m", "middle, m", "middle, m"};
  for (const analyse::TeamMeasure& team : teams) {
    table.rows.push_back({team.team, std::to_string(team.people), fmt::format("{:.0f}", team.distance_m),
                          fmt::format("{:.1f}", team.length_m), fmt::format("{:.1f}", team.width_m),
                          fmt::format("{:.0f}", team.hull_m2), fmt::format("{:.1f}", team.average_position.x()),
                          fmt::format("{:.1f}", team.average_position.y())});
  }
}

/// By team and number; soft hyphens where a narrow table may break a head.
void add_people(const analyse::Measurement& measured, const analyse::MeasureOptions& options, draw::MatchReport& report) {
  constexpr const char *speed = "speed, m/s", *efforts = "efforts", *zones = "metres at m/s";
  report.columns = {"distance, m", "mean", "top", "± top", "sprints", "acceler\u00ADations", "deceler\u00ADations", "seen, s"};
  report.groups = {"", speed, speed, speed, efforts, efforts, efforts, ""};
  for (std::size_t zone = 0; zone <= options.zones.size(); ++zone) {
    report.columns.push_back(zone_name(options.zones, zone));
    report.groups.emplace_back(zones);
  }
  for (const analyse::PersonMeasure& person : measured.people) report.people.push_back(page_of(person));
  std::stable_sort(report.people.begin(), report.people.end(), [](const auto& a, const auto& b) { return a.team < b.team; });
}

/// "22 people of blue and white over 90.0 min, on a pitch of 105 × 68 m."
std::string lead_of(const analyse::Measurement& measured, const analyse::MeasureOptions& options, const Recording& recording) {
  const auto& instants = recording.instants();
  const double length_s = instants.empty() ? 0 : seconds(instants.back().time - instants.front().time);
  std::string teams;
  for (std::size_t i = 0; i < measured.teams.size(); ++i)
    teams += (i == 0 ? " of " : i + 1 < measured.teams.size() ? ", " : " and ") + measured.teams[i].team;
  return fmt::format("{} people{} over {}, on a pitch of {:g} × {:g} m.", measured.people.size(), teams,
                     length_s < 120 ? fmt::format("{:.1f} s", length_s) : fmt::format("{:.1f} min", length_s / 60),
                     options.pitch.length, options.pitch.width);
}

draw::MatchReport report_of(const analyse::Measurement& measured, const MeasureMatchOptions& options,
                            const format::match::GroundMatch& match, const std::string& title) {
  draw::MatchReport report;
  report.title = title;
  report.lead = lead_of(measured, options.how, match.recording);
  report.pitch.size = options.how.pitch;
  report.pitch.y_down = options.y_down.value_or(y_grows_down(match.recording.header));
  report.periods = periods_of(match);
  add_people(measured, options.how, report);
  if (!measured.teams.empty()) add_team_table(measured.teams, report);
  if (measured.ball) add_ball_tables(*measured.ball, report);
  add_impossible(measured, report);
  return report;
}

void write_report(const draw::MatchReport& report, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error("{}: this folder cannot be made ({})", folder, error.message());
  WholeFile file((std::filesystem::path(folder) / "report.html").string());
  file.write(draw::to_html(report));
  file.finish();
}

}  // namespace

MatchMeasurement measure_match(const std::string& tracks, const MeasureOutput& output, const MeasureMatchOptions& options,
                               const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  const format::ReadOptions reading{options.metadata, options.how.pitch, options.rate_hz};
  const format::match::GroundMatch match = format::read_match(tracks, reading);
  MatchMeasurement result{.measured = analyse::measure(match.recording, options.how), .warnings = {}};
  if (result.measured.people.empty()) throw Error("{}: no person is in it for long enough to be measured", tracks);
  WholeFile file(output.figures);
  file.write(measurement_csv(result.measured, options.how));
  if (!output.report.empty()) {
    if (!options.y_down) {
      if (auto message_text = orientation_unknown(tracks, match.recording.header))
        result.warnings.push_back(std::move(*message_text));
    }
    draw::MatchReport report = report_of(result.measured, options, match, std::filesystem::path(tracks).stem().string());
    report.notes = result.warnings;
    write_report(report, output.report);
  }
  file.finish();
  return result;
}

}  // namespace marey::pipeline::take

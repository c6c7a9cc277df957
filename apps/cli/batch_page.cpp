#include "batch_page.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <set>

#include <fmt/format.h>

#include "marey/draw/page.h"
#include "marey/files/natural_order.h"

namespace marey::cli {
namespace {

constexpr std::size_t kMaxLines = 8;  // of a chart, so that they can be distinguished

/// The season's rows by what their columns are called.
class SeasonTable {
 public:
  explicit SeasonTable(const Season& season) {
    for (std::size_t i = 0; i < season.columns.size(); ++i) column_.emplace(season.columns[i], i);
    for (const auto& row : season.rows) {
      if (index_.try_emplace(row.front(), recordings_.size()).second) recordings_.push_back(row.front());
    }
  }

  /// By the plan's order, from 0.
  std::size_t index_of(const std::string& recording) const { return index_.at(recording); }
  bool has(const std::string& column) const { return column_.contains(column); }
  const std::vector<std::string>& recordings() const { return recordings_; }

  std::string text(const std::vector<std::string>& row, const std::string& column) const {
    const auto found = column_.find(column);
    return found == column_.end() ? std::string() : row[found->second];
  }
  double number(const std::vector<std::string>& row, const std::string& column) const {
    const std::string field = text(row, column);
    double value = 0;
    std::from_chars(field.data(), field.data() + field.size(), value);
    return value;
  }

  /// Who it is in every recording: the name, else the team; a number alone is another's in the next recording.
  std::string identity(const std::vector<std::string>& row) const {
    const std::string label = text(row, "label"), team = text(row, "team");
    if (label.empty()) return team.empty() ? "no person by name" : team + ", without a name";
    return team.empty() ? label : label + ", " + team;
  }

 private:
  std::map<std::string, std::size_t> column_;
  std::vector<std::string> recordings_;  // in the plan's order
  std::map<std::string, std::size_t> index_;
};

struct Total {
  std::set<std::string> recordings;
  double distance_m = 0, seconds = 0, top_mps = 0, sprints = 0;
};

using Totals = std::map<std::string, Total, NaturalOrder>;

Totals totals_of(const Season& season, const SeasonTable& table) {
  Totals totals;
  for (const auto& row : season.rows) {
    Total& total = totals[table.identity(row)];
    total.recordings.insert(row.front());
    total.distance_m += table.number(row, "distance_m");
    total.seconds += table.number(row, "seconds");
    total.sprints += table.number(row, "sprints");
    total.top_mps = std::max(total.top_mps, table.number(row, "max_mps"));
  }
  return totals;
}

draw::PageTable table_of(const Totals& totals) {
  draw::PageTable table{
      .title = "Totals", .head = {"who", "recordings", "distance, km", "minutes", "m a minute", "sprints", "top, m/s"}, .rows = {}};
  for (const auto& [identity, total] : totals) {
    const double minutes = total.seconds / 60;
    table.rows.push_back({identity, std::to_string(total.recordings.size()), fmt::format("{:.2f}", total.distance_m / 1000),
                          fmt::format("{:.1f}", minutes), fmt::format("{:.0f}", minutes > 0 ? total.distance_m / minutes : 0),
                          fmt::format("{:.0f}", total.sprints), fmt::format("{:.1f}", total.top_mps)});
  }
  return table;
}

/// The lines whose values are largest in all. A chart of one recording would be points: nothing.
void add_chart(std::string title, std::string y, const std::map<std::string, std::map<std::size_t, double>>& values,
               std::size_t recordings, std::vector<draw::LineChart>& charts) {
  if (recordings < 2 || values.empty()) return;
  std::vector<std::pair<double, std::string>> by_size;
  for (const auto& [name, line] : values) {
    double sum = 0;
    for (const auto& [x, value] : line) sum += value;
    by_size.emplace_back(-sum, name);
  }
  std::sort(by_size.begin(), by_size.end());
  draw::LineChart& chart = charts.emplace_back();
  chart.title = std::move(title), chart.y_label = std::move(y), chart.x_label = "recording";
  for (std::size_t i = 0; i < std::min(by_size.size(), kMaxLines); ++i) {
    draw::LineChart::Line& line = chart.lines.emplace_back();
    line.name = by_size[i].second;
    for (const auto& [x, value] : values.at(line.name)) line.points.emplace_back(static_cast<double>(x + 1), value);
  }
}

/// `add(row)` of each line's name, put together within a recording by `together`.
using Values = std::map<std::string, std::map<std::size_t, double>>;
Values by_recording(const Season& season, const SeasonTable& table,
                    const std::function<std::string(const std::vector<std::string>&)>& name,
                    const std::function<double(double before, const std::vector<std::string>&)>& together) {
  Values values;
  for (const auto& row : season.rows) {
    double& value = values[name(row)][table.index_of(row.front())];
    value = together(value, row);
  }
  return values;
}

/// A column of the season that a coach reads, and what stands above it; the table that is written has all.
struct ShownColumn {
  std::string column, head, group;
};

std::vector<ShownColumn> shown_columns(const Season& season) {
  constexpr const char *speed = "speed, m/s", *efforts = "efforts";
  std::vector<ShownColumn> shown{{"recording", "recording", ""},
                                 {"id", "no.", ""},
                                 {"label", "name", ""},
                                 {"team", "team", ""},
                                 {"distance_m", "distance, m", ""},
                                 {"mean_mps", "mean", speed},
                                 {"max_mps", "top", speed},
                                 {"sprints", "sprints", efforts},
                                 {"accelerations", "acceler\u00ADations", efforts},
                                 {"decelerations", "deceler\u00ADations", efforts},
                                 {"seen_s", "seen, s", ""}};
  for (const std::string& column : season.columns) {  // "m_at_over 7_mps"
    constexpr std::string_view begin = "m_at_", end = "_mps";
    if (column.starts_with(begin) && column.ends_with(end))
      shown.push_back({column, column.substr(begin.size(), column.size() - begin.size() - end.size()), "metres at m/s"});
  }
  return shown;
}

/// As many digits as are worth reading.
std::string rounded_figure(const std::string& field, const std::string& column) {
  double value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || end != field.data() + field.size()) return field;
  if (column == "mean_mps") return fmt::format("{:.2f}", value);
  if (column == "max_mps") return fmt::format("{:.1f}", value);
  return fmt::format("{:.0f}", value);
}

/// Whether recordings are called by their numbers where there is little room: a table lists their names.
bool by_number(const std::vector<std::string>& recordings) {
  constexpr std::size_t kMostBytes = 16;
  return std::any_of(recordings.begin(), recordings.end(), [](const std::string& name) { return name.size() > kMostBytes; });
}

draw::PageTable recordings_of(const SeasonTable& table) {
  draw::PageTable all{.title = "Recordings", .head = {"no.", "recording"}, .rows = {}, .bars_end = 0};
  for (std::size_t i = 0; i < table.recordings().size(); ++i) all.rows.push_back({std::to_string(i + 1), table.recordings()[i]});
  return all;
}

draw::PageTable all_people_of(const Season& season, const SeasonTable& table) {
  draw::PageTable all{.title = "Everybody", .head = {}, .rows = {}, .bars_from = 4};
  const std::vector<ShownColumn> shown = shown_columns(season);
  const bool numbered = by_number(table.recordings());
  for (const ShownColumn& column : shown) {
    all.head.push_back(column.head);
    all.groups.push_back(column.group);
  }
  for (const auto& row : season.rows) {
    auto& cells = all.rows.emplace_back();
    for (std::size_t i = 0; i < shown.size(); ++i) {
      const std::string field = table.text(row, shown[i].column);
      cells.push_back(i < 4 ? field : rounded_figure(field, shown[i].column));
    }
    if (numbered) cells.front() = std::to_string(table.index_of(row.front()) + 1);
  }
  return all;
}

void add_measured(draw::Page& page, const Season& season, const SeasonTable& table) {
  page.add(table_of(totals_of(season, table)));
  const auto identity = [&](const std::vector<std::string>& row) { return table.identity(row); };
  const auto sum = [&](double before, const std::vector<std::string>& row) {
    return before + table.number(row, "distance_m") / 1000;
  };
  const auto top = [&](double before, const std::vector<std::string>& row) {
    return std::max(before, table.number(row, "max_mps"));
  };
  std::vector<draw::LineChart> charts;
  add_chart("Distance from recording to recording", "km", by_recording(season, table, identity, sum), table.recordings().size(),
            charts);
  add_chart("Top speed from recording to recording", "m/s", by_recording(season, table, identity, top), table.recordings().size(),
            charts);
  page.add(charts);
  page.add(recordings_of(table));
  page.add(all_people_of(season, table));
}

void add_counted(draw::Page& page, const Season& season, const SeasonTable& table) {
  const auto tracks = [](const auto&) { return std::string("tracks"); };
  const auto count = [](double before, const auto&) { return before + 1; };
  std::vector<draw::LineChart> charts;
  add_chart("Tracks from recording to recording", "number", by_recording(season, table, tracks, count), table.recordings().size(),
            charts);
  page.add(charts);
  page.add(recordings_of(table));
  draw::PageTable all{.title = "Everybody", .head = season.columns, .rows = season.rows};
  for (std::string& head : all.head) std::replace(head.begin(), head.end(), '_', ' ');
  all.bars_from = 4;
  page.add(all);
}

}  // namespace

std::string season_page(const Season& season, const std::string& title, std::size_t planned) {
  draw::Page page(title);
  page.add_message(fmt::format("{} of {} recordings are done, in {:.1f} s of work; the largest took {} MB.", season.done, planned,
                               season.seconds, season.peak_mb));
  if (!season.failures.empty()) {
    draw::PageTable failures{.title = "What is missing, and why", .head = {"task", "recording", "why"}, .rows = {}};
    failures.bars_end = 0;
    for (const Season::Failure& failure : season.failures)
      failures.rows.push_back({std::to_string(failure.number), failure.name, failure.why});
    page.add(failures);
  }
  const SeasonTable table(season);
  table.has("distance_m") ? add_measured(page, season, table) : add_counted(page, season, table);
  return page.html();
}

}  // namespace marey::cli

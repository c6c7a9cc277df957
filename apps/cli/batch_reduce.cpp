#include "batch_reduce.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/input_file.h"
#include "marey/format/recording_file.h"
#include "marey/format/text_rows.h"

namespace marey::cli {
namespace {

/// The fields of a line of CSV; quotes as format::quoted_field sets them.
std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"') {
      fields.back() += line[++i];
    } else if (c == '"') {
      quoted = !quoted;
    } else if (c == ',' && !quoted) {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

/// Puts rows under their columns' names; a column that others lack stays empty there.
class Table {
 public:
  explicit Table(Season& season) : season_(season) { season_.columns = {"recording"}; }

  void add(const std::string& recording, const std::vector<std::string>& head, const std::vector<std::string>& row) {
    std::vector<std::string> whole(season_.columns.size());
    whole[0] = recording;
    for (std::size_t i = 0; i < std::min(head.size(), row.size()); ++i) {
      auto column = std::find(season_.columns.begin() + 1, season_.columns.end(), head[i]);
      const auto at = static_cast<std::size_t>(column - season_.columns.begin());
      if (column == season_.columns.end()) season_.columns.push_back(head[i]);
      if (whole.size() <= at) whole.resize(at + 1);
      whole[at] = row[i];
    }
    season_.rows.push_back(std::move(whole));
  }

 private:
  Season& season_;
};

void add_measured(const BatchTask& task, Table& table) {
  InputStream file(task.output);
  std::string line;
  if (!file || !std::getline(file, line)) throw Error("{}: cannot be read", task.output);
  const std::vector<std::string> head = fields_of(line);
  while (std::getline(file, line)) table.add(task.name, head, fields_of(line));
}

void add_counted(const BatchTask& task, Table& table) {
  static const std::vector<std::string> head{"id", "label", "team", "first_frame", "last_frame", "measured", "filled", "predicted"};
  const auto reader = format::open_recording(task.output);
  const RecordingSummary summary = reader->summary();
  for (const RecordingSummary::TrackCount& track : summary.tracks) {
    const auto count = [&](Provenance provenance) { return std::to_string(track.of(provenance)); };
    table.add(task.name, head,
              {std::to_string(number(track.name.id)), track.name.label, track.name.team,
               std::to_string(track.first_index.value_or(0)), std::to_string(track.last_index.value_or(0)),
               count(Provenance::measured), count(Provenance::filled), count(Provenance::predicted)});
  }
}

/// Empty if it is done.
std::string why_not(const std::optional<TaskRecord>& record, const BatchTask& task) {
  std::error_code error;
  if (!record) return "was not run to its end: not begun, stopped, or its machine was lost; run it again";
  if (!record->done)
    return record->message_text.empty() ? fmt::format("ended with exit code {}", record->exit_code) : record->message_text;
  if (record->hash != task.hash()) return "was done with other options or another input; run it again";
  if (!std::filesystem::exists(task.output, error)) return task.output + ": is not there any more; run it again";
  return {};
}

}  // namespace

Season reduce(const BatchPlan& plan) {
  Season season;
  Table table(season);
  for (const BatchTask& task : plan.tasks) {
    stop_point();
    try {
      const auto record = read_record(plan.record_of(task));
      std::string why = why_not(record, task);
      if (why.empty()) {
        task.job == "measure" ? add_measured(task, table) : add_counted(task, table);
        ++season.done;
        season.seconds += record->seconds;
        if (record->peak_mb > season.peak_mb) season.peak_mb = record->peak_mb, season.planned_mb = task.costs.memory_mb;
      } else {
        season.failures.push_back({task.number, task.name, std::move(why)});
      }
    } catch (const Error& error) {
      season.failures.push_back({task.number, task.name, error.what()});
    }
  }
  for (auto& row : season.rows) row.resize(season.columns.size());
  return season;
}

std::string season_csv(const Season& season) {
  std::string text;
  const auto add = [&](const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) text += (i == 0 ? "" : ",") + format::quoted_field(fields[i]);
    text += '\n';
  };
  add(season.columns);
  for (const auto& row : season.rows) add(row);
  return text;
}

}  // namespace marey::cli

// How `marey experiment trackers` presents its figures: as the paper's tables, and as plots of them.
#include <cmath>
#include <filesystem>
#include <iterator>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/draw/chart.h"
#include "marey/draw/svg.h"
#include "marey/files/whole_file.h"
#include "marey/filter/filters.h"
#include "marey/simulate/markers/marker_scene.h"

#include "experiments/markdown_table.h"
#include "experiments/trackers.h"

namespace marey::experiments {
namespace {

constexpr std::array<const char*, TrackerRow::kSituations> kNames{"slow", "rapid", "acceleration", "occlusion", "swap"};
constexpr std::array<const char*, TrackerRow::kMotions> kErrorTables{"II", "III", "IV"};

std::vector<const TrackerRow*> all_rows(const TrackerExperiment& experiment) {
  std::vector<const TrackerRow*> rows;
  for (const TrackerRow& row : experiment.paper) rows.push_back(&row);
  for (const TrackerRow& row : experiment.ours) rows.push_back(&row);
  return rows;
}

void add_losses(std::string& text, const TrackerExperiment& experiment) {
  fmt::format_to(std::back_inserter(text), "Table I. Videos in which a marker's name was lost, of {} (paper: of 20)\n{:<28}",
                 experiment.videos, "");
  for (const char* name : kNames) fmt::format_to(std::back_inserter(text), "{:>14}", name);
  text += '\n';
  for (const TrackerRow* row : all_rows(experiment)) {
    fmt::format_to(std::back_inserter(text), "{:<28}", row->method);
    for (const auto& losses : row->losses)
      fmt::format_to(std::back_inserter(text), "{:>14}", losses ? std::to_string(*losses) : "-");
    text += '\n';
  }
}

void add_errors(std::string& text, const TrackerExperiment& experiment, std::size_t motion) {
  fmt::format_to(std::back_inserter(text),
                 "\nTable {}. Prediction error, {}, px, in videos without a loss, with its 99 % interval\n", kErrorTables[motion],
                 kNames[motion]);
  fmt::format_to(std::back_inserter(text), "{:<28}{:>10}{:>10}{:>10}{:>10}\n", "", "samples", "lower", "mean", "upper");
  for (const TrackerRow* row : all_rows(experiment)) {
    const auto& error = row->errors[motion];
    if (!error || error->samples == 0) {
      fmt::format_to(std::back_inserter(text), "{:<28}{:>10}\n", row->method, 0);
    } else {
      fmt::format_to(std::back_inserter(text), "{:<28}{:>10}{:>10.2f}{:>10.2f}{:>10.2f}\n", row->method, error->samples, error->low,
                     error->mean, error->high);
    }
  }
}

void add_times(std::string& text, const TrackerExperiment& experiment) {
  text += "\nTables V-VII. Time of the tracking step alone over 200 frames, ms: 5th percentile, median, 95th, maximum\n";
  for (const TrackerRow* row : all_rows(experiment)) {
    fmt::format_to(std::back_inserter(text), "{}\n", row->method);
    for (const StepTime& time : row->times) {
      fmt::format_to(std::back_inserter(text), "{:>12} markers{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", time.markers,
                     time.percentile_5, time.median, time.percentile_95, time.maximum);
    }
  }
}

draw::BarChart loss_chart(const TrackerExperiment& experiment) {
  draw::BarChart chart{
      fmt::format("Table I: losses, of {} videos", experiment.videos), "videos with a loss", {kNames.begin(), kNames.end()}, {}};
  for (const TrackerRow* row : all_rows(experiment)) {
    auto& group = chart.groups.emplace_back();
    group.name = row->method;
    for (const auto& losses : row->losses) {
      group.bars.push_back(losses ? std::optional(draw::Bar{static_cast<double>(*losses), {}, {}}) : std::nullopt);
    }
  }
  return chart;
}

draw::BarChart error_chart(const TrackerExperiment& experiment, std::size_t motion) {
  draw::BarChart chart{fmt::format("Table {}: prediction error, {}", kErrorTables[motion], kNames[motion]),
                       "px, mean with 99 % interval",
                       {"error"},
                       {}};
  for (const TrackerRow* row : all_rows(experiment)) {
    const auto& error = row->errors[motion];
    auto& group = chart.groups.emplace_back();
    group.name = row->method;
    group.bars.push_back(error && error->samples > 0 ? std::optional(draw::Bar{error->mean, error->low, error->high})
                                                     : std::nullopt);
  }
  return chart;
}

draw::LineChart time_chart(const TrackerExperiment& experiment) {
  draw::LineChart chart{"Tables V-VII: time of the tracking step, median", "markers", "ms", true, {}};
  for (const TrackerRow* row : all_rows(experiment)) {
    auto& line = chart.lines.emplace_back();
    line.name = row->method;
    for (const StepTime& time : row->times) {
      if (time.median > 0) line.points.emplace_back(time.markers, time.median);
    }
  }
  return chart;
}

/// Like the paper's Figure 3: the path of a rapid zigzag, dashed; the marker; the alpha-beta filter's prediction and search area.
std::string search_image(std::uint64_t seed) {
  const simulate::markers::MarkerScene scene =
      simulate::markers::simulate_markers(simulate::markers::MarkerSituation::rapid_zigzag, seed);
  const filter::AlphaBetaOptions options;
  filter::AlphaBeta<2> filter(options, scene.frames.front()[0].position, Matrix<2>::Zero());
  const std::size_t shown = scene.frames.size() / 2;
  std::vector<Vector<2>> path;
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const Vector<2>& location = scene.frames[i][0].position;
    path.push_back(location);
    if (i == 0 || i > shown) continue;
    filter.predict(1 / scene.options.rate_hz);
    if (i < shown) filter.correct(location, Matrix<2>::Zero());
  }
  const Vector<2>& marker = scene.frames[shown][0].position;
  const Vector<2> predicted = filter.position();
  const double width = scene.options.size.width, height = scene.options.size.height;
  draw::Svg svg({{"viewBox", fmt::format("0 0 {} {}", width, height)}, {"width", width}, {"height", height}});
  svg.rect({0, 0, width, height}, {{"fill", "#0c0c0c"}});
  svg.polyline(path, {{"stroke", "#bbb"}, {"stroke-dasharray", "5 4"}});
  svg.circle(marker, scene.options.radius_px, {{"fill", "#cacaca"}});
  svg.circle(predicted, 3, {{"fill", "red"}});
  svg.circle(predicted, options.search_radius, {{"fill", "none"}, {"stroke", "#4af"}, {"stroke-width", 1.5}});
  return svg.str();
}

}  // namespace

std::string to_text(const TrackerExperiment& experiment) {
  std::string text;
  add_losses(text, experiment);
  for (std::size_t motion = 0; motion < TrackerRow::kMotions; ++motion) add_errors(text, experiment, motion);
  add_times(text, experiment);
  return text;
}

std::string to_markdown(const TrackerExperiment& experiment) {
  std::vector<std::string> titles{""};
  for (const char* name : kNames) titles.emplace_back(name);
  for (std::size_t motion = 0; motion < TrackerRow::kMotions; ++motion) titles.push_back(fmt::format("{}, px", kNames[motion]));
  std::string text = markdown_header(titles);
  for (const TrackerRow* row : all_rows(experiment)) {
    std::vector<std::string> cells{row->method};
    for (const auto& losses : row->losses) cells.push_back(losses ? std::to_string(*losses) : "–");
    for (const auto& error : row->errors) cells.push_back(error && error->samples > 0 ? fmt::format("{:.2f}", error->mean) : "–");
    text += markdown_row(cells);
  }
  return text;
}

std::vector<std::string> draw_experiment(const TrackerExperiment& experiment, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw Error("{}: the folder cannot be made ({})", folder, error.message());
  std::vector<std::string> names;
  const auto save = [&](const std::string& name, const std::string& svg) {
    const std::string path = (std::filesystem::path(folder) / name).string();
    WholeFile file(path);
    file.write(svg);
    file.finish();
    names.push_back(path);
  };
  save("table_1_losses.svg", draw::to_svg(loss_chart(experiment)));
  for (std::size_t motion = 0; motion < TrackerRow::kMotions; ++motion) {
    save(fmt::format("table_{}_error_{}.svg", motion + 2, kNames[motion]), draw::to_svg(error_chart(experiment, motion)));
  }
  save("tables_5_7_time.svg", draw::to_svg(time_chart(experiment)));
  save("figure_3_search.svg", search_image(experiment.seed));
  return names;
}

}  // namespace marey::experiments

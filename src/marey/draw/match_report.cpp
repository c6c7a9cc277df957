#include "marey/draw/match_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include <fmt/format.h>

#include "marey/draw/pitch_svg.h"
#include "marey/draw/svg.h"
#include "marey/files/text_safety.h"

namespace marey::draw {
namespace {

constexpr int kDecimals = 2;       // of speeds that are drawn
constexpr double kMaxPath = 2000;  // points drawn of a path: more is not seen

constexpr double kTerritoryCell = 5;  // m
constexpr double kTerritory = 0.5;    // of a team's time on the pitch is spent in its territory

// Of Okabe and Ito's colours those that are seen on grass, for teams whose shirts are not known.
constexpr std::array<const char*, 5> kTeamColours{"#e69f00", "#cc79a7", "#56b4e9", "#f0e442", "#bbbbbb"};

class ReportPage {
 public:
  explicit ReportPage(const MatchReport& report) : report_(report) {
    for (const MatchReport::Person& person : report.people) {
      if (colours_.contains(person.team)) continue;
      if (person.appearance)
        colours_[person.team] = colour_on_grass(*person.appearance);
      else
        colours_[person.team] = kTeamColours[colours_.size() % kTeamColours.size()];
    }
  }

  std::string write() {
    Page page(report_.title);
    page.add_message(report_.lead);
    page.add_list(report_.notes);
    add_people(page);
    for (PageTable table : report_.tables) {
      table.colours = colours_;
      page.add(table);
    }
    add("{}", PitchSvg::lines_html(report_.pitch));
    write_territories();
    add("<h2>Where every person went</h2><div class=\"one\">");
    PitchSvg all(report_.pitch);
    const double opacity = opacity_of(report_.people, 0.25);
    for (const MatchReport::Person& person : report_.people) draw_paths(all.field(), person, 0.25, opacity);
    add("{}</div>", all.html());
    page.add_html(std::exchange(text_, {}));
    page.add_legend({colours_.begin(), colours_.end()});
    add("<h2>One by one</h2><p>Where each was longest, the way, and the speed over time.</p>");
    for (const MatchReport::Person& person : report_.people) write_person(person);
    page.add_html(text_);
    return page.html();
  }

 private:
  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void add_people(Page& page) const {
    PageTable table{"People", {"no.", "name", "team"}, {}, 3};
    table.groups.assign(table.head.size(), {});
    table.groups.insert(table.groups.end(), report_.groups.begin(), report_.groups.end());
    table.head.insert(table.head.end(), report_.columns.begin(), report_.columns.end());
    table.colours = colours_;
    for (const MatchReport::Person& person : report_.people) {
      auto& row = table.rows.emplace_back(std::vector{std::to_string(person.number), person.name, person.team});
      row.insert(row.end(), person.cells.begin(), person.cells.end());
    }
    page.add(table);
  }

  /// Seconds that a team's people were in each cell, by rows.
  std::vector<double> territory_seconds(const std::string& team, const MatchReport::Period& period, int columns, int rows) const {
    std::vector<double> seconds(static_cast<std::size_t>(columns * rows), 0);
    for (const MatchReport::Person& person : report_.people) {
      if (person.team != team) continue;
      for (std::size_t p = 0; p < person.paths.size(); ++p) {
        const auto& path = person.paths[p];
        const auto& times = person.speeds[p];
        for (std::size_t i = 1; i < std::min(path.size(), times.size()); ++i) {
          if (times[i].first < period.begin_s || times[i].first > period.end_s) continue;
          const Vector<2> at = (path[i] - report_.pitch.corner) / kTerritoryCell;
          const int column = static_cast<int>(std::floor(at.x())), row = static_cast<int>(std::floor(at.y()));
          if (column >= 0 && row >= 0 && column < columns && row < rows)
            seconds[static_cast<std::size_t>(row) * columns + column] += times[i].first - times[i - 1].first;
        }
      }
    }
    return seconds;
  }

  /// A team's half of its time on the smallest part of the pitch; halves side by side.
  void write_territories() {
    if (colours_.size() > 8 || (colours_.size() == 1 && colours_.begin()->first.empty())) return;
    std::vector<MatchReport::Period> periods = report_.periods;
    if (periods.empty()) periods.push_back({"whole recording", -1e300, 1e300});
    add("<h2>Territories</h2><p>The smallest part of the pitch on which a team spent half of its time.</p><div class=\"two\">");
    for (const auto& [team, colour] : colours_) {
      for (const MatchReport::Period& period : periods) {
        if (!team.empty()) write_territory(team, period);
      }
    }
    add("</div>");
  }

  void write_territory(const std::string& team, const MatchReport::Period& period) {
    const int columns = static_cast<int>(std::ceil(report_.pitch.size.length / kTerritoryCell));
    const int rows = static_cast<int>(std::ceil(report_.pitch.size.width / kTerritoryCell));
    const std::vector<double> seconds = territory_seconds(team, period, columns, rows);
    const std::vector<bool> full = fullest_cells(seconds, kTerritory);
    const double maximum = *std::max_element(seconds.begin(), seconds.end());
    double area = 0;
    PitchSvg svg(report_.pitch);
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const std::size_t cell = static_cast<std::size_t>(row) * columns + column;
        if (!full[cell]) continue;
        area += kTerritoryCell * kTerritoryCell;
        svg.field().rect(cell_at(column, row, kTerritoryCell),
                         {{"fill", colours_.at(team)}, {"fill-opacity", 0.35 + 0.55 * seconds[cell] / maximum}});
      }
    }
    add("<figure>{}", svg.html());
    add("<figcaption>{}, {}: {:.0f} m²</figcaption></figure>", xml_escaped(team), xml_escaped(period.name), area);
  }

  Box cell_at(int column, int row, double size) const {
    return {report_.pitch.corner.x() + column * size, report_.pitch.corner.y() + row * size, size, size};
  }

  static std::size_t step_of(std::size_t points) {
    return static_cast<std::size_t>(std::ceil(std::max(1.0, static_cast<double>(points) / kMaxPath)));
  }

  /// Paths that cover the pitch many times over are drawn fainter, so that one still sees where they lie closest.
  double opacity_of(std::span<const MatchReport::Person> people, double width) const {
    double length = 0;
    for (const MatchReport::Person& person : people) {
      for (const auto& path : person.paths) {
        const std::size_t step = step_of(path.size());
        for (std::size_t i = step; i < path.size(); i += step) length += (path[i] - path[i - step]).norm();
      }
    }
    const double covered = length * width / (report_.pitch.size.length * report_.pitch.size.width);
    return 0.95 / (1 + 5 * covered);
  }

  void draw_paths(SvgElement& svg, const MatchReport::Person& person, double width, double opacity) const {
    for (const auto& path : person.paths) {
      std::vector<Vector<2>> points;
      for (std::size_t i = 0; i < path.size(); i += step_of(path.size())) points.push_back(path[i]);
      svg.polyline(
          points,
          {{"stroke", colours_.at(person.team)}, {"stroke-width", width}, {"stroke-opacity", fmt::format("{:.3f}", opacity)}});
    }
  }

  void draw_heat(SvgElement& svg, const MatchReport::Person& person) const {
    const double maximum = person.heat.empty() ? 0 : *std::max_element(person.heat.begin(), person.heat.end());
    for (int row = 0; row < person.heat_rows; ++row) {
      for (int column = 0; column < person.heat_columns; ++column) {
        const double seconds = person.heat[static_cast<std::size_t>(row) * person.heat_columns + column];
        if (seconds <= 0) continue;
        svg.rect(cell_at(column, row, person.heat_cell_m),
                 {{"fill", "#ffd54a"}, {"fill-opacity", std::sqrt(seconds / maximum) * 0.85}});
      }
    }
  }

  static std::string sprints_of(const MatchReport::Person& person) {
    const std::size_t count = person.sprints.size();
    return count == 0 ? "no sprint" : count == 1 ? "1 sprint is marked" : fmt::format("{} sprints are marked", count);
  }

  /// The speeds that are known; `place(time, speed)` is where each is drawn.
  template <typename Location>
  static void draw_known(Svg& svg, const MatchReport::Person& person, const Location& location) {
    for (std::size_t p = 0; p < person.speeds.size(); ++p) {
      const auto& path = person.speeds[p];
      std::vector<Vector<2>> points;
      const auto draw = [&] {
        if (points.size() > 1) svg.polyline(points, {{"class", "speed"}, {"stroke-width", 0.4}});
        points.clear();
      };
      for (std::size_t i = 0; i < path.size(); i += step_of(path.size())) {
        if (person.detected[p][i]) points.push_back(location(path[i].first, path[i].second));
        if (!person.detected[p][i]) draw();
      }
      draw();
    }
  }

  void draw_speeds(const MatchReport::Person& person) {
    constexpr double width = 105, height = 68, left = 8, bottom = 8;
    double begin = 1e300, end = -1e300, fastest = 8;
    for (std::size_t p = 0; p < person.speeds.size(); ++p) {
      for (std::size_t i = 0; i < person.speeds[p].size(); ++i) {
        const auto& [time, speed] = person.speeds[p][i];
        begin = std::min(begin, time), end = std::max(end, time);
        if (person.detected[p][i]) fastest = std::max(fastest, speed);
      }
    }
    if (!(end > begin)) return;
    const auto location = [&](double time, double speed) {
      return Vector<2>(left + (width - left) * (time - begin) / (end - begin), (height - bottom) * (1 - speed / fastest));
    };
    Svg svg({{"viewBox", fmt::format("-2 -4 {} {}", width + 4, height + 6)}, {"font-size", 3.2}, {"font-family", "sans-serif"}},
            kDecimals);
    for (double speed = 0; speed <= fastest; speed += 2) {
      const double y = location(begin, speed).y();
      svg.line({left, y}, {width, y}, {{"class", "grid"}, {"stroke-width", 0.2}});
      svg.text({left - 1, y + 1}, fmt::format("{:g}", speed), {{"class", "axis"}, {"text-anchor", "end"}});
    }
    svg.text({left, height - 1}, fmt::format("m/s over {:.0f} s, where it is known; {}", end - begin, sprints_of(person)),
             {{"class", "axis"}});
    for (const auto& [from, to] : person.sprints) {
      constexpr double narrowest = 0.3;
      const double x = location(from, 0).x();
      svg.rect({x, 0, std::max(narrowest, location(to, 0).x() - x), height - bottom}, {{"class", "sprint"}})
          .add("title", {}, fmt::format("{:.1f} s to {:.1f} s", from, to));
    }
    draw_known(svg, person, location);
    text_ += svg.str();
  }

  void write_person(const MatchReport::Person& person) {
    const std::string own = std::to_string(person.number);
    add("<details><summary>{}{} {}</summary><div class=\"two\"><div>",
        person.name == own    ? ""
        : person.name.empty() ? own
                              : own + " · ",
        xml_escaped(person.name), xml_escaped(person.team));
    PitchSvg svg(report_.pitch);
    draw_heat(svg.field(), person);
    draw_paths(svg.field(), person, 0.3, opacity_of({&person, 1}, 0.3));
    add("{}</div><div>", svg.html());
    draw_speeds(person);
    add("</div></div></details>");
  }

  const MatchReport& report_;
  std::map<std::string, std::string> colours_;  // of teams, CSS
  std::string text_;
};

}  // namespace

std::vector<bool> fullest_cells(const std::vector<double>& seconds, double fraction) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  const double required = fraction * std::accumulate(seconds.begin(), seconds.end(), 0.0);
  std::vector<bool> full(seconds.size(), false);
  double sum = 0;
  for (const std::size_t cell : order) {
    if (sum >= required) break;
    full[cell] = true;
    sum += seconds[cell];
  }
  return full;
}

std::string to_html(const MatchReport& report) {
  return ReportPage(report).write();
}

}  // namespace marey::draw

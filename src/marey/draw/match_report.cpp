#include "marey/draw/match_report.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <span>

#include <fmt/format.h>

#include "marey/draw/canvas.h"
#include "marey/draw/svg_text.h"

namespace marey::draw {
namespace {

constexpr double kPitchMargin = 3;     // m round the pitch
constexpr double kLongestPath = 2000;  // points drawn of a path: more is not seen

const char* const kStyle = R"(
body { font: 15px/1.4 system-ui, sans-serif; margin: 2em auto; max-width: 70em; color: #222; padding: 0 1em }
table { border-collapse: collapse; margin: 1em 0 } th, td { padding: .25em .8em; text-align: right; border-bottom: 1px solid #ddd }
th:nth-child(-n+2), td:nth-child(-n+2) { text-align: left } th { background: #f4f4f4 }
svg { width: 100%; height: auto } details { margin: .5em 0 } summary { cursor: pointer; font-weight: bold }
.two { display: grid; grid-template-columns: 1fr 1fr; gap: 1em } h2 { margin-top: 1.5em }
)";

class ReportPage {
 public:
  explicit ReportPage(const MatchReport& report) : report_(report) {
    for (const MatchReport::Person& person : report.people) teams_.try_emplace(person.team, static_cast<int>(teams_.size()));
  }

  std::string write() {
    add("<!doctype html>\n<html lang=\"en\"><head><meta "
        "charset=\"utf-8\"><title>{0}</title><style>{1}</style></head><body><h1>{0}</h1>",
        escaped(report_.title), kStyle);
    define_lines();
    write_people();
    for (const MatchReport::Table& table : report_.tables) write_table(table);
    add("<h2>Where everybody went</h2>");
    open_pitch();
    const double opacity = opacity_of(report_.people, 0.25);
    for (const MatchReport::Person& person : report_.people) draw_paths(person, 0.25, opacity);
    close_pitch();
    add("<h2>One by one</h2>");
    for (const MatchReport::Person& person : report_.people) write_person(person);
    add("</body></html>");
    return std::move(text_);
  }

 private:
  template <typename... Args>
  void add(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Args>(args)...);
    text_ += '\n';
  }

  void write_people() {
    MatchReport::Table table{"People", {"name", "team"}, {}};
    table.head.insert(table.head.end(), report_.columns.begin(), report_.columns.end());
    for (const MatchReport::Person& person : report_.people) {
      auto& row = table.rows.emplace_back(std::vector{person.name, person.team});
      row.insert(row.end(), person.cells.begin(), person.cells.end());
    }
    write_table(table);
  }

  void write_table(const MatchReport::Table& table) {
    add("<h2>{}</h2><table><tr>", escaped(table.title));
    for (const std::string& cell : table.head) add("<th>{}</th>", escaped(cell));
    add("</tr>");
    for (const auto& row : table.rows) {
      add("<tr>");
      for (const std::string& cell : row) add("<td>{}</td>", escaped(cell));
      add("</tr>");
    }
    add("</table>");
  }

  void open_pitch() {
    const Vector<2>& c = report_.corner;
    add(R"(<svg viewBox="{:.2f} {:.2f} {:.2f} {:.2f}">)", c.x() - kPitchMargin, c.y() - kPitchMargin,
        report_.pitch.length + 2 * kPitchMargin, report_.pitch.width + 2 * kPitchMargin);
    add(R"(<rect x="{:.2f}" y="{:.2f}" width="100%" height="100%" fill="#5f9469"/>)", c.x() - kPitchMargin, c.y() - kPitchMargin);
  }

  void close_pitch() { add(R"(<use href="#lines"/></svg>)"); }

  /// The pitch's lines, once for all its pictures.
  void define_lines() {
    constexpr double step = 0.1;  // m
    add(R"(<svg style="position: absolute; width: 0; height: 0"><defs><g id="lines">)");
    for (const geometry::PitchLine& line : geometry::pitch_lines(report_.pitch, step)) {
      text_ += R"(<polyline fill="none" stroke="#d8e6da" stroke-width="0.15" points=")";
      for (const Vector<2>& point : line.points) {
        const Vector<2> place = point + report_.corner;
        fmt::format_to(std::back_inserter(text_), "{:.2f},{:.2f} ", place.x(), place.y());
      }
      text_ += "\"/>\n";
    }
    add("</g></defs></svg>");
  }

  std::string colour(const MatchReport::Person& person) const {
    const Colour c = person.appearance ? colour_of(*person.appearance) : colour_of(teams_.at(person.team));
    return fmt::format("#{:02x}{:02x}{:02x}", c.red, c.green, c.blue);
  }

  static std::size_t step_of(std::size_t points) {
    return static_cast<std::size_t>(std::ceil(std::max(1.0, static_cast<double>(points) / kLongestPath)));
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
    const double covered = length * width / (report_.pitch.length * report_.pitch.width);
    return 0.8 / (1 + 8 * covered);
  }

  void draw_paths(const MatchReport::Person& person, double width, double opacity) {
    for (const auto& path : person.paths) {
      const std::size_t step = step_of(path.size());
      fmt::format_to(std::back_inserter(text_),
                     R"(<polyline fill="none" stroke="{}" stroke-width="{}" stroke-opacity="{:.3f}" points=")", colour(person),
                     width, opacity);
      for (std::size_t i = 0; i < path.size(); i += step)
        fmt::format_to(std::back_inserter(text_), "{:.2f},{:.2f} ", path[i].x(), path[i].y());
      text_ += "\"/>\n";
    }
  }

  void draw_heat(const MatchReport::Person& person) {
    const double most = person.heat.empty() ? 0 : *std::max_element(person.heat.begin(), person.heat.end());
    for (int row = 0; row < person.heat_rows; ++row) {
      for (int column = 0; column < person.heat_columns; ++column) {
        const double seconds = person.heat[static_cast<std::size_t>(row) * person.heat_columns + column];
        if (seconds <= 0) continue;
        add(R"(<rect x="{0:.2f}" y="{1:.2f}" width="{2:g}" height="{2:g}" fill="#ffd54a" fill-opacity="{3:.2f}"/>)",
            report_.corner.x() + column * person.heat_cell_m, report_.corner.y() + row * person.heat_cell_m, person.heat_cell_m,
            std::sqrt(seconds / most) * 0.85);
      }
    }
  }

  void draw_speeds(const MatchReport::Person& person) {
    constexpr double width = 105, height = 68, left = 8, bottom = 8;
    double begin = 1e300, end = -1e300, fastest = 8;
    for (const auto& path : person.speeds) {
      for (const auto& [time, speed] : path)
        begin = std::min(begin, time), end = std::max(end, time), fastest = std::max(fastest, speed);
    }
    if (!(end > begin)) return;
    const auto x = [&](double time) { return left + (width - left) * (time - begin) / (end - begin); };
    const auto y = [&](double speed) { return height - bottom - (height - bottom) * speed / fastest; };
    add(R"(<svg viewBox="-2 -4 {} {}" font-size="3.2" font-family="sans-serif">)", width + 4, height + 6);
    for (double speed = 0; speed <= fastest; speed += 2) {
      add(R"(<line x1="{0}" x2="{1}" y1="{2:.2f}" y2="{2:.2f}" stroke="#ddd" stroke-width="0.2"/>)", left, width, y(speed));
      add(R"(<text x="{}" y="{:.2f}" text-anchor="end">{:g}</text>)", left - 1, y(speed) + 1, speed);
    }
    add(R"(<text x="{}" y="{}">m/s over {:.0f} s</text>)", left, height - 1, end - begin);
    for (const auto& path : person.speeds) {
      const std::size_t step = step_of(path.size());
      fmt::format_to(std::back_inserter(text_), R"(<polyline fill="none" stroke="#222" stroke-width="0.4" points=")");
      for (std::size_t i = 0; i < path.size(); i += step)
        fmt::format_to(std::back_inserter(text_), "{:.2f},{:.2f} ", x(path[i].first), y(path[i].second));
      text_ += "\"/>\n";
    }
    add("</svg>");
  }

  void write_person(const MatchReport::Person& person) {
    add("<details><summary>{} {}</summary><div class=\"two\"><div>", escaped(person.name), escaped(person.team));
    open_pitch();
    draw_heat(person);
    draw_paths(person, 0.3, opacity_of({&person, 1}, 0.3));
    close_pitch();
    add("</div><div>");
    draw_speeds(person);
    add("</div></div></details>");
  }

  const MatchReport& report_;
  std::map<std::string, int> teams_;
  std::string text_;
};

}  // namespace

std::string to_html(const MatchReport& report) {
  return ReportPage(report).write();
}

}  // namespace marey::draw

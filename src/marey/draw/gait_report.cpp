#include "marey/draw/gait_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/gait_charts.h"
#include "marey/draw/page.h"
#include "marey/files/text_safety.h"

namespace marey::draw {
namespace {

constexpr const char* kUnknownFigure = "–";
constexpr std::size_t kColumnsOfBoth = 3, kColumnsOfSide = 4;
constexpr std::size_t kPanelsInFour = 32, kPanelsInFive = 50;  // that fit on a sheet in four and in five columns

/// Three digits, as many as the measurement has.
int decimals_of(double value) {
  return std::clamp(2 - static_cast<int>(std::floor(std::log10(std::max(std::abs(value), 1e-9)))), 0, 3);
}

std::string with_deviation(const std::optional<double>& mean, const std::optional<double>& deviation, int decimals) {
  if (!mean) return kUnknownFigure;
  return deviation ? fmt::format("{:.{}f} ± {:.{}f}", *mean, decimals, *deviation, decimals)
                   : fmt::format("{:.{}f}", *mean, decimals);
}

int decimals_of(const GaitReport::Figure& figure) {
  const auto largest = std::max(std::abs(figure.mean[0].value_or(0)), std::abs(figure.mean[1].value_or(0)));
  return decimals_of(largest);
}

/// "+1.2", and "0.0" without a sign.
std::string signed_tenths(double value) {
  const double rounded = std::round(10 * value) / 10;
  return rounded == 0 ? "0.0" : fmt::format("{:+.1f}", rounded);
}

/// (left − right) over the mean of both, in % (Robinson, Herzog, Nigg 1987).
std::string asymmetry(const GaitReport::Figure& figure) {
  if (!figure.mean[0] || !figure.mean[1]) return kUnknownFigure;
  const double mean = 0.5 * (*figure.mean[0] + *figure.mean[1]);
  return std::abs(mean) < 1e-9 ? kUnknownFigure : signed_tenths(100 * (*figure.mean[0] - *figure.mean[1]) / mean);
}

/// Columns that no row has are empty, and the page omits them.
PageTable figures_table(const std::string& title, const std::vector<GaitReport::Figure>& figures, bool percent) {
  PageTable table{.title = title,
                  .head = {percent ? "figure" : "variable", "left", "right", percent ? "left − right, %" : "left − right",
                           "control group", "left", "right"},
                  .rows = {}};
  table.groups = {"", "", "", "", "", "before", "before"};
  table.bars_end = 0;
  table.cards = true;
  for (const GaitReport::Figure& figure : figures) {
    const int decimals = percent ? decimals_of(figure) : 1;
    const auto before = [&](std::size_t side) {
      return figure.before[side] ? fmt::format("{:.{}f}", *figure.before[side], decimals) : std::string();
    };
    const std::string difference = percent                            ? asymmetry(figure)
                                   : figure.mean[0] && figure.mean[1] ? signed_tenths(*figure.mean[0] - *figure.mean[1])
                                                                      : kUnknownFigure;
    table.rows.push_back({figure.unit.empty() ? figure.name : figure.name + ", " + figure.unit,
                          with_deviation(figure.mean[0], figure.deviation[0], decimals),
                          with_deviation(figure.mean[1], figure.deviation[1], decimals), difference,
                          figure.reference ? with_deviation(figure.reference, figure.reference_deviation, decimals) : std::string(),
                          before(0), before(1)});
  }
  return table;
}

PageTable events_table(const GaitReport& report) {
  PageTable table{.title = "Events", .head = {"time, s", "side", "event", "deviation, ms"}, .rows = {}};
  table.bars_end = 0;
  table.folded = true;
  for (const GaitReport::Event& event : report.events)
    table.rows.push_back(
        {fmt::format("{:.3f}", event.time_s), event.side, event.kind, fmt::format("{:.0f}", 1000 * event.deviation_s)});
  return table;
}

class GaitPage {
 public:
  explicit GaitPage(const GaitReport& report) : report_(report), page_(report.title) {}

  std::string write() {
    write_summary();
    if (!report_.legs.empty()) write_curves("Left and right", GaitSides::both, {&report_.legs});
    write_curves("Left side", GaitSides::left, {&report_.legs, &report_.forces, &report_.muscles});
    write_curves("Right side", GaitSides::right, {&report_.legs, &report_.forces, &report_.muscles});
    write_curves("Forces and moments, left and right", GaitSides::both, {&report_.forces});
    write_curves("Trunk and arms", GaitSides::both, {&report_.trunk});
    write_quality();
    return page_.html();
  }

 private:
  bool has_before() const {
    const auto has = [](const GaitReport::Panel& panel) {
      return !panel.sides[0].before.mean.empty() || !panel.sides[1].before.mean.empty();
    };
    return std::any_of(report_.legs.begin(), report_.legs.end(), has);
  }

  void begin_sheet(const std::string& heading) {
    page_.add_html("<section class=\"sheet\">\n");
    if (!heading.empty())
      page_.add_html(fmt::format("<h2>{}<small>{}</small></h2>\n", xml_escaped(heading), xml_escaped(report_.title)));
  }
  void end_sheet() { page_.add_html("</section>\n"); }

  void write_legend(GaitSides sides, bool with_reference, bool with_before) {
    std::vector<std::pair<std::string, std::string>> legend;
    if (sides != GaitSides::right) legend.emplace_back("left", kGaitLeft);
    if (sides != GaitSides::left) legend.emplace_back("right", kGaitRight);
    if (with_reference) legend.emplace_back("control group", "#7f8c8d59");
    if (with_before && has_before()) legend.emplace_back("before (dashed)", "var(--text)");
    page_.add_legend(legend);
  }

  void write_summary() {
    begin_sheet("");
    for (const std::string& sentence : report_.lead) page_.add_message(sentence);
    page_.add(figures_table("Times and lengths", report_.figures, true));
    page_.add_message(
        "± is one standard deviation over the cycles (n − 1): how much the walk varies, not how exact the measurement is. Of the "
        "control group it is the deviation over people, each person counts once. A figure without ± has one cycle. Left − right is "
        "in % of the mean of both: 0 is symmetric.");
    write_profile();
    if (!report_.warnings.empty())
      page_.add_message(fmt::format("{} {} on the last sheet.", report_.warnings.size(),
                                    report_.warnings.size() == 1 ? "warning is" : "warnings are"));
    end_sheet();
  }

  void write_profile() {
    if (report_.scores.empty()) return;
    page_.add_heading("Movement Analysis Profile and Gait Profile Score");
    page_.add_html("<figure>" + gait_profile_chart(report_) + "</figure>\n");
    write_legend(GaitSides::both, true, true);
    std::string overall = report_.overall_score ? fmt::format("Gait Profile Score of both sides: {:.1f}°", *report_.overall_score)
                                                : "No Gait Profile Score of both sides: a variable is not known";
    if (report_.overall_before) overall += fmt::format(", before {:.1f}°", *report_.overall_before);
    page_.add_message(
        overall +
        ". A score is the RMS difference from the control group's mean over the cycle; the Gait Profile Score is the RMS of "
        "a side's nine (Baker et al. 2009). Grey: what people of the group score against the others of it, mean and one "
        "deviation. A change of 1.6° is held to matter to patients (Baker et al. 2012).");
    page_.add(figures_table("Scores, degrees", report_.scores, false));
  }

  void write_curves(const std::string& heading, GaitSides sides, const std::vector<const std::vector<GaitReport::Panel>*>& groups) {
    std::vector<const GaitReport::Panel*> panels;
    for (const auto* group : groups) {
      for (const GaitReport::Panel& panel : *group) {
        const bool left = !panel.sides[0].now.mean.empty(), right = !panel.sides[1].now.mean.empty();
        if (sides == GaitSides::both ? left || right : sides == GaitSides::left ? left : right) panels.push_back(&panel);
      }
    }
    if (panels.empty()) return;
    const std::size_t of_side =
        panels.size() <= kPanelsInFour ? kColumnsOfSide : kColumnsOfSide + (panels.size() <= kPanelsInFive ? 1 : 2);
    const std::size_t columns = sides == GaitSides::both ? kColumnsOfBoth : of_side;
    begin_sheet(heading);
    page_.add_message(
        sides == GaitSides::both
            ? "Mean over the cycles, from a strike of the foot to its next; the band is one standard deviation over the "
              "cycles. Dotted: the foot leaves the ground."
            : "Each cycle (thin), their mean and one standard deviation. Dotted: the foot leaves the ground.");
    const bool reference =
        std::any_of(panels.begin(), panels.end(), [](const GaitReport::Panel* panel) { return !panel->reference.mean.empty(); });
    write_legend(sides, reference, sides != GaitSides::both);
    page_.add_html(fmt::format("<div class=\"panels\" style=\"--columns:{}\">", columns));
    for (const GaitReport::Panel* panel : panels) page_.add_html("<figure>" + gait_panel(*panel, sides, report_) + "</figure>");
    page_.add_html("</div>\n");
    end_sheet();
  }

  void write_quality() {
    begin_sheet("Quality");
    page_.add_list(report_.quality);
    if (!report_.warnings.empty()) page_.add_html("<h3>Warnings</h3>\n");
    page_.add_list(report_.warnings);
    for (const PageTable& table : report_.tables) page_.add(table);
    page_.add(events_table(report_));
    end_sheet();
  }

  const GaitReport& report_;
  Page page_;
};

}  // namespace

std::string to_html(const GaitReport& report) {
  return GaitPage(report).write();
}

}  // namespace marey::draw

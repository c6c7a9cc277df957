#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "marey/calibrate/rig_report.h"

namespace marey::calibrate {
namespace {

struct Grade {
  const char* word;
  double noise_px;  // up to, for an image of 1280 columns
  double length;    // up to, relative error of the wand
  double coverage;  // from
  double outliers;  // up to, share
  const char* use;
};

constexpr std::array kGrades = {Grade{"excellent", 0.25, 0.002, 0.30, 0.03, "fit for measuring"},
                                Grade{"good", 0.5, 0.005, 0.20, 0.08, "fit for motion capture"},
                                Grade{"fair", 1.0, 0.015, 0.00, 0.20, "usable, but tracks will be lost where cameras disagree"},
                                Grade{"poor", 1e9, 1e9, 0, 1, "calibrate again before relying on it"}};

/// The first grade that a measure passes.
template <typename Passes>
std::size_t best(Passes passes) {
  return static_cast<std::size_t>(std::find_if(kGrades.begin(), kGrades.end() - 1, passes) - kGrades.begin());
}

}  // namespace

void grade(RigReport& report, int columns, double wand_m) {
  std::size_t worst = 0;
  std::string limit;
  const auto assess = [&](std::size_t level, std::string what) {
    if (level <= worst) return;
    worst = level;
    limit = std::move(what);
  };
  const double noise = report.noise_px * 1280 / std::max(1, columns);
  assess(best([&](const Grade& g) { return noise <= g.noise_px; }),
         fmt::format("the markers' noise of {:.2f} px", report.noise_px));
  if (report.held_out && wand_m > 0) {
    const double off = report.held_out->length_rms_mm / (1000 * wand_m);
    assess(best([&](const Grade& g) { return off <= g.length; }),
           fmt::format("the wand's length, off by {:.1f} mm", report.held_out->length_rms_mm));
  }
  const auto minimum = std::min_element(report.cameras.begin(), report.cameras.end(),
                                        [](const CameraReport& a, const CameraReport& b) { return a.coverage < b.coverage; });
  if (minimum != report.cameras.end()) {
    assess(best([&](const Grade& g) { return minimum->coverage >= g.coverage; }),
           fmt::format("{}, in which only {:.0f} % of the image was covered", minimum->name, 100 * minimum->coverage));
  }
  const double outliers = 1 - static_cast<double>(report.all.inliers) / std::max(1, report.all.observations);
  assess(best([&](const Grade& g) { return outliers <= g.outliers; }), fmt::format("{:.0f} % of outliers", 100 * outliers));
  report.grade = kGrades[worst].word;
  report.meaning = fmt::format("{}{}{}", kGrades[worst].use, limit.empty() ? "" : "; limited by ", limit);
}

}  // namespace marey::calibrate

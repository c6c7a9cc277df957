#include "marey/calibrate/ptz/smooth_ptz.h"

#include <algorithm>
#include <cmath>

#include "marey/calibrate/ptz/frame_fit.h"
#include "marey/filter/smoother.h"

namespace marey::calibrate::ptz {
namespace {

/// Pan and tilt were found for another focal length than they have now.
Vector<3> step_of(const Rotated& rotated, double log_focal) {
  const double scale = std::exp(rotated.log_focal - log_focal);
  return {scale * rotated.by.x(), scale * rotated.by.y(), rotated.by.z()};
}

constexpr int kMaxBridge = 12;                        // frames before a piece's first known one that flow alone gives
constexpr double kWideAngle = 0.05, kWideZoom = 0.2;  // of a piece's first frame, before its paint: rad, ln f

filter::Estimate<3> estimate_of(const Aim& aim) {
  return {aim.heading.as_vector(), aim.covariance};
}

struct Filtered {
  std::optional<Aim> expected;  // before its paint
  std::optional<Aim> aim;
};

std::vector<Filtered> filtered(const std::vector<TurnRecord>& records, const geometry::Tripod& tripod, cv::Size size,
                               const SmoothOptions& options) {
  std::vector<Filtered> all(records.size());
  for (std::size_t i = 0; i < records.size(); ++i) {
    const TurnRecord& record = records[i];
    Filtered& here = all[i];
    if (!record.found) continue;
    if (i > 0 && all[i - 1].aim && record.rotated) {
      here.expected = next_aim(*all[i - 1].aim, *record.rotated, options);
    } else if (record.found && !record.paint.empty()) {
      here.expected =
          Aim{record.found->heading,
              Vector<3>(kWideAngle * kWideAngle, kWideAngle * kWideAngle, kWideZoom * kWideZoom).asDiagonal().toDenseMatrix()};
    }
    if (!here.expected) continue;
    here.aim = here.expected;
    if (!record.paint.empty()) here.aim = solve_aim(tripod, size, record.paint, *here.expected, options.aim).aim;
  }
  return all;
}

}  // namespace

Matrix<3> flow_covariance(const Rotated& rotated, double log_focal, const SmoothOptions& options) {
  const double angle = options.flow_px / 640 * std::exp(-log_focal), zoom = options.flow_zoom;
  const Vector<3> moving = options.moving_fraction * rotated.by;
  const double turned = options.moving_zoom * std::exp(log_focal) * rotated.by.head<2>().norm();
  const Matrix<3> noise = Vector<3>(angle * angle + moving.x() * moving.x(), angle * angle + moving.y() * moving.y(),
                                    zoom * zoom + moving.z() * moving.z() + turned * turned)
                              .asDiagonal();
  return noise + rotated.ambiguity * rotated.ambiguity.transpose();
}

Aim next_aim(const Aim& before, const Rotated& rotated, const SmoothOptions& options) {
  return {geometry::Heading::of(before.heading.as_vector() + step_of(rotated, before.heading.log_focal)),
          before.covariance + flow_covariance(rotated, before.heading.log_focal, options)};
}

Aim previous_aim(const Aim& after, const Rotated& rotated, const SmoothOptions& options) {
  return {geometry::Heading::of(after.heading.as_vector() - step_of(rotated, after.heading.log_focal)),
          after.covariance + flow_covariance(rotated, after.heading.log_focal, options)};
}

bool same_aim(const Aim& a, const Aim& b, const SmoothOptions& options) {
  const Aim off{a.heading, a.covariance + b.covariance};
  const Vector<3> by = a.heading.as_vector() - b.heading.as_vector();
  const double px = 640 * std::max(std::exp(a.heading.log_focal) * by.head<2>().norm(), 0.7 * std::abs(by.z()));
  return px < options.same_px + options.same_deviations * unsure_px(off);
}

std::vector<std::optional<Aim>> smooth_ptz(const std::vector<TurnRecord>& records, const geometry::Tripod& tripod, cv::Size size,
                                           const SmoothOptions& options) {
  const std::vector<Filtered> forwards = filtered(records, tripod, size, options);
  std::vector<std::optional<Aim>> smooth(records.size());
  int alone = 0;  // frames in a row that only later frames determine
  for (std::size_t k = records.size(); k-- > 0;) {
    smooth[k] = forwards[k].aim;
    if (smooth[k]) alone = 0;
    if (k + 1 == records.size() || !smooth[k + 1] || !records[k + 1].rotated) continue;
    const Rotated& rotated = *records[k + 1].rotated;
    if (!forwards[k].aim) {
      if (++alone > kMaxBridge) {
        smooth[k].reset();
        continue;
      }
      // Before the first known frame of a piece there is only what came after it.
      smooth[k] = previous_aim(*smooth[k + 1], rotated, options);
      continue;
    }
    if (!forwards[k + 1].expected) continue;  // after a loss: nothing leads from here to there
    const Aim& here = *forwards[k].aim;
    const Aim& expected = *forwards[k + 1].expected;
    const auto smoothed =
        filter::smoothed_back<3, 1>(estimate_of(here), Matrix<3>::Identity(), estimate_of(expected), estimate_of(*smooth[k + 1]));
    smooth[k] = Aim{geometry::Heading::of(smoothed.mean), smoothed.covariance};
  }
  return smooth;
}

}  // namespace marey::calibrate::ptz

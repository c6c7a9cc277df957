#include "marey/calibrate/ptz/relocalise.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/SVD>

#include "marey/calibrate/ptz/line_markings.h"
#include "marey/geometry/ground_view.h"

namespace marey::calibrate::ptz {
namespace {

constexpr std::size_t kRefinedStarts = 250;  // of the coarse headings; numerical: cost alone
constexpr std::size_t kRefined = 8;          // headings that are inspected closely

HeadingRange heading_range_about(const NearHeading& near, const FindAgainOptions& options) {
  const double angle = std::min(options.max_near_angle, options.near_angle + options.near_angle_rate * near.frames),
               zoom = std::min(options.max_near_zoom, options.near_zoom + options.near_zoom_rate * near.frames);
  const Vector<3> middle = near.heading.as_vector(), half(angle, angle / 2, zoom);
  HeadingRange range{middle - half, middle + half};
  range.minimum.z() = std::max(range.minimum.z(), options.min_log_focal);
  range.maximum.z() = std::min(range.maximum.z(), options.max_log_focal);
  return range;
}

/// The fraction of the paint mask that a heading explains; what it puts beside the pitch counts little, for or against.
double explained_by(const PaintMask& seen, const geometry::Tripod& tripod, const geometry::Heading& heading,
                    const geometry::PitchSize& pitch, const FindAgainOptions& options) {
  const GroundView view(geometry::camera_of(tripod, heading, seen.near.size()));
  double on = 0, all = 1e-9;
  for (const Vector<2>& position : seen.positions) {
    const auto location = view.location(position);
    if (!location) continue;
    const Vector<2>& ground = location->ground;
    const bool beside = ground.x() < -options.beyond || ground.y() < -options.beyond ||
                        ground.x() > pitch.length + options.beyond || ground.y() > pitch.width + options.beyond;
    const double metres = geometry::distance_to_line(pitch, ground);
    // Across a line a pixel is between these two lengths of ground.
    const Eigen::JacobiSVD<Matrix<2>> extent(location->by_pixel);
    const bool there = metres < options.explained_px * std::sqrt(extent.singularValues()(0) * extent.singularValues()(1));
    all += beside ? options.off_pitch_weight : 1;
    on += beside ? 0 : there ? 1 : 0;
  }
  return on / all;
}

/// The best, if it is enough and no other one is nearly as good.
std::optional<AimFit> decided(const std::vector<ImageEvidence>& all, const FindAgainOptions& options) {
  if (all.empty() || !all.front().enough(options)) return std::nullopt;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (!alike(all[i].fit.aim.heading, all.front().fit.aim.heading) && all[i].merit() > options.rival * all.front().merit())
      return std::nullopt;
  }
  return all.front().fit;
}

}  // namespace

double ImageEvidence::merit() const {
  return explained * fit.agreeing * fit.agreeing / std::max(1.0, 1.0 * expected);
}

double ImageEvidence::both() const {
  return std::sqrt(explained * std::min(1.0, fit.agreeing / std::max(1.0, 1.0 * expected)));
}

bool ImageEvidence::enough(const FindAgainOptions& options) const {
  return fit.agreeing >= options.min_agreeing && fit.lines >= options.lines && fit.agreeing >= options.fraction * expected &&
         both() >= options.both;
}

bool alike(const geometry::Heading& a, const geometry::Heading& b) {
  const Vector<3> off = a.as_vector() - b.as_vector();
  return off.head<2>().norm() < 0.01 && std::abs(off.z()) < 0.03;
}

ImageEvidence evidence_of(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod,
                          const geometry::PitchSize& pitch, std::span<const geometry::PitchLine> lines,
                          const geometry::Heading& start, const FindAgainOptions& options) {
  const cv::Mat& luma = image.luma();
  ImageEvidence result;
  result.fit.aim.heading = start;
  for (const double reach : {14.0, 8.0, 4.0, 4.0}) {
    PaintOptions how;
    how.reach = reach * std::max(1.0, luma.cols / 1280.0);
    Paint paint = find_paint(luma, tripod, result.fit.aim.heading, lines, how);
    const Aim expected{result.fit.aim.heading, Vector<3>(2.5e-4, 2.5e-4, 2.5e-3).asDiagonal()};
    result.fit = solve_aim(tripod, luma.size(), paint.detected, expected);
    result.expected = paint.expected;
    result.paint = std::move(paint.detected);
  }
  result.explained = explained_by(seen, tripod, result.fit.aim.heading, pitch, options);
  return result;
}

std::vector<ImageEvidence> headings_by_evidence(const Image& image, const PaintMask& seen, const geometry::Tripod& tripod,
                                                const geometry::PitchSize& pitch, std::span<const geometry::PitchLine> lines,
                                                const SearchLines& search, const std::vector<geometry::Heading>& headings,
                                                std::size_t count, const FindAgainOptions& options) {
  std::vector<ImageEvidence> all;
  for (const HeadingCandidate& one : best_headings(seen, tripod, search, headings, kRefinedStarts, count))
    all.push_back(evidence_of(image, seen, tripod, pitch, lines, climbed(seen, tripod, search, one).heading, options));
  std::stable_sort(all.begin(), all.end(), [](const ImageEvidence& a, const ImageEvidence& b) { return a.merit() > b.merit(); });
  return all;
}

std::optional<AimFit> find_again(const Image& image, const geometry::Tripod& tripod, const geometry::PitchSize& pitch,
                                 std::span<const geometry::PitchLine> lines, const SearchLines& search,
                                 const FindAgainOptions& options) {
  const PaintMask seen = paint_mask(image, options.mask);
  const double aspect = static_cast<double>(seen.near.rows) / seen.near.cols;
  if (options.near) {
    const auto headings = headings_in(heading_range_about(*options.near, options), aspect, false);
    const auto near = headings_by_evidence(image, seen, tripod, pitch, lines, search, headings, options.near_count, options);
    if (const auto found = decided(near, options)) return found;
  }
  if (!options.everywhere) return std::nullopt;
  const auto range = headings_over_pitch(tripod, pitch, options.min_log_focal, options.max_log_focal);
  const auto headings = headings_in(range, aspect, true);
  return decided(headings_by_evidence(image, seen, tripod, pitch, lines, search, headings, kRefined, options), options);
}

}  // namespace marey::calibrate::ptz

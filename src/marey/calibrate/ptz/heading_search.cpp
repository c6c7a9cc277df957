#include "marey/calibrate/ptz/heading_search.h"

#include <algorithm>
#include <cmath>

#include <opencv2/core/utility.hpp>

namespace marey::calibrate::ptz {
namespace {

constexpr double kCoarse = 9;          // shrunk px between headings that are tried about the best, twice as much elsewhere
constexpr double kZoomStep = 0.13;     // of ln f
constexpr float kMissingLine = 0.55F;  // what a piece of line that is not there counts against
constexpr float kMinDepth = 5;         // m before the camera; numerical
constexpr float kMaxBent = 4;          // half image widths squared: beyond, the radial term grows no more; numerical

std::vector<HeadingCandidate> rated_headings(const cv::Mat& near, const geometry::Tripod& tripod, const LineSamples& lines,
                                             const std::vector<geometry::Heading>& headings) {
  std::vector<HeadingCandidate> all(headings.size());
  cv::parallel_for_(cv::Range(0, static_cast<int>(headings.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto at = static_cast<std::size_t>(i);
      all[at] = {headings[at], lines.score(near, tripod, headings[at])};
    }
  });
  return all;
}

void best_scores(std::vector<HeadingCandidate>& all, std::size_t count) {
  const auto better = [](const HeadingCandidate& a, const HeadingCandidate& b) {
    return a.score != b.score ? a.score > b.score : a.heading.as_vector().sum() < b.heading.as_vector().sum();
  };
  count = std::min(count, all.size());
  std::partial_sort(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(count), all.end(), better);
  all.resize(count);
}

double coarse_step(const geometry::Heading& heading) {
  return kCoarse / (std::exp(heading.log_focal) * kMaskWidth / 2);
}

/// One of the 27 headings about another: itself and a step to each side.
geometry::Heading neighbour(const geometry::Heading& heading, int code, double step, double zoom) {
  return {heading.pan + (code % 3 - 1) * step, heading.tilt + (code / 3 % 3 - 1) * step, heading.log_focal + (code / 9 - 1) * zoom};
}

/// Headings between the coarse ones, about each of the best of them.
std::vector<geometry::Heading> headings_about(const std::vector<HeadingCandidate>& best) {
  std::vector<geometry::Heading> headings;
  for (const HeadingCandidate& one : best) {
    for (int code = 0; code < 27; ++code) headings.push_back(neighbour(one.heading, code, coarse_step(one.heading), kZoomStep / 2));
  }
  return headings;
}

}  // namespace

LineSamples::LineSamples(std::span<const geometry::PitchLine> lines, std::size_t stride) {
  for (const geometry::PitchLine& line : lines) {
    for (std::size_t i = 0; i < line.points.size(); i += stride) {
      x_.push_back(static_cast<float>(line.points[i].x())), y_.push_back(static_cast<float>(line.points[i].y()));
      begins_.push_back(i == 0 ? 1 : 0);
    }
  }
}

double LineSamples::score(const cv::Mat& near, const geometry::Tripod& tripod, const geometry::Heading& heading) const {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  const float half = static_cast<float>(near.cols) / 2;
  const Eigen::Vector3f right = (frame.focal * frame.right).cast<float>(), down = (frame.focal * frame.down).cast<float>(),
                        ahead = frame.ahead.cast<float>();
  const auto constant = [&](const Eigen::Vector3f& axis) { return -axis.dot(frame.centre.cast<float>()); };
  const float right_0 = constant(right), down_0 = constant(down), ahead_0 = constant(ahead), bend = static_cast<float>(frame.bend);
  const std::size_t count = x_.size();
  thread_local std::vector<float> buffer;
  buffer.resize(3 * count);
  float *u = buffer.data(), *v = u + count, *depth = v + count;
  const float *x = x_.data(), *y = y_.data();
  const float middle_u = (static_cast<float>(near.cols) - 1) / 2, middle_v = (static_cast<float>(near.rows) - 1) / 2;
  for (std::size_t i = 0; i < count; ++i) {
    const float z = ahead.x() * x[i] + ahead.y() * y[i] + ahead_0, inverse = 1 / std::max(z, 0.5F);
    const float across = (right.x() * x[i] + right.y() * y[i] + right_0) * inverse,
                along = (down.x() * x[i] + down.y() * y[i] + down_0) * inverse;
    const float bent = half * (1 + bend * std::min(kMaxBent, across * across + along * along));
    u[i] = middle_u + across * bent;
    v[i] = middle_v + along * bent;
    depth[i] = z;
  }
  float score = 0;
  const auto columns = static_cast<float>(near.cols - 1), rows = static_cast<float>(near.rows - 1);
  for (std::size_t i = 1; i < count; ++i) {
    if (!(u[i] >= 0 && v[i] >= 0 && u[i] < columns && v[i] < rows)) continue;
    if (begins_[i] != 0 || depth[i] < kMinDepth || depth[i - 1] < kMinDepth) continue;
    const float across = u[i] - u[i - 1], along = v[i] - v[i - 1];
    const float length = std::min(40.0F, std::sqrt(across * across + along * along));
    const float here = near.ptr<float>(static_cast<int>(v[i] + 0.5F))[static_cast<int>(u[i] + 0.5F)];
    score += length * (here > 0 ? here : -kMissingLine);
  }
  return score;
}

HeadingRange headings_over_pitch(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, double min_log_focal,
                                 double max_log_focal) {
  HeadingRange range;
  const Vector<2> middle = Vector<2>(pitch.length / 2, pitch.width / 2) - tripod.location.head<2>();
  const double straight = std::atan2(middle.x(), middle.y());
  for (const double x : {0.0, pitch.length}) {
    for (const double y : {0.0, pitch.width}) {
      const Vector<2> to = Vector<2>(x, y) - tripod.location.head<2>();
      const double pan = straight + std::remainder(std::atan2(to.x(), to.y()) - straight, 2 * M_PI);
      const Vector<3> corner(pan, std::atan2(tripod.location.z(), to.norm()), min_log_focal);
      range.minimum = range.minimum.cwiseMin(corner), range.maximum = range.maximum.cwiseMax(corner);
    }
  }
  range.maximum.z() = max_log_focal;
  return range;
}

std::vector<geometry::Heading> headings_in(const HeadingRange& range, double aspect, bool with_margin) {
  std::vector<geometry::Heading> headings;
  for (double log_focal = range.minimum.z(); log_focal <= range.maximum.z(); log_focal += 1.5 * kZoomStep) {
    const double step = 2 * coarse_step({0, 0, log_focal}), half = with_margin ? 0.6 * aspect / std::exp(log_focal) : 0;
    for (double pan = range.minimum.x(); pan <= range.maximum.x(); pan += step) {
      for (double tilt = std::max(0.0, range.minimum.y() - half); tilt <= range.maximum.y() + half / 2; tilt += step)
        headings.push_back({pan, tilt, log_focal});
    }
  }
  return headings;
}

std::vector<HeadingCandidate> best_headings(const PaintMask& seen, const geometry::Tripod& tripod, const SearchLines& lines,
                                            const std::vector<geometry::Heading>& headings, std::size_t starts, std::size_t count) {
  std::vector<HeadingCandidate> all = rated_headings(seen.about, tripod, lines.coarse, headings);
  best_scores(all, starts);
  all = rated_headings(seen.near, tripod, lines.middle, headings_about(all));
  best_scores(all, all.size());
  std::vector<HeadingCandidate> best;
  for (const HeadingCandidate& one : all) {
    const bool apart = std::all_of(best.begin(), best.end(), [&](const HeadingCandidate& other) {
      const double angle = std::hypot(one.heading.pan - other.heading.pan, one.heading.tilt - other.heading.tilt);
      return angle > 2.5 * coarse_step(one.heading) || std::abs(one.heading.log_focal - other.heading.log_focal) > 2.5 * kZoomStep;
    });
    if (apart) best.push_back(one);
    if (best.size() == count) break;
  }
  return best;
}

HeadingCandidate climbed(const PaintMask& seen, const geometry::Tripod& tripod, const SearchLines& lines, HeadingCandidate at) {
  at.score = lines.fine.score(seen.near, tripod, at.heading);
  for (double part = 0.5; part > 0.1; part /= 1.6) {
    for (int round = 0; round < 4; ++round) {
      HeadingCandidate best = at;
      for (int code = 0; code < 27; ++code) {
        const geometry::Heading heading = neighbour(at.heading, code, part * coarse_step(at.heading), part * kZoomStep);
        const double score = lines.fine.score(seen.near, tripod, heading);
        if (score > best.score) best = {heading, score};
      }
      if (best.score <= at.score) break;
      at = best;
    }
  }
  return at;
}

}  // namespace marey::calibrate::ptz

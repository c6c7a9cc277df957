// The position of an edge is known to the noise of light over its slope, and the slope is the contrast over the width of the blur:
// an edge of 40 levels, blurred over 2 px, in noise of 6 levels, to 0.3 px. Something of the scene that hides a body ends it along
// an edge that the scene has itself, which is why such an edge counts as seen only where the scene is even.
#include "marey/track/contour/colour/visible_edge.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace marey::track::contour::colour {
namespace {

constexpr double kReach = 2;            // cells to either side of the curve that are compared, beyond the blur of an edge; unswept
constexpr double kBlurredNoise = 14;    // levels × px: noise of light times the width of an edge; unswept
constexpr double kMinDeviation = 0.35;  // px: what remains of an edge in chroma of half the resolution; unswept
constexpr float kAlike = 9;             // levels: the noise of a difference of two cells; unswept
constexpr float kChromaPart = 0.4F;     // of squared differences: format, chroma has half the resolution
constexpr float kTaken = 0.5F;          // by definition: more likely another body than not
constexpr double kBorderBand = 1.5;     // px from the border of the image: numerical

std::optional<cv::Point> cell_at(const ColourPatch& patch, const Vector<2>& pixel) {
  const Vector<2> cell = patch.cell(pixel);
  const cv::Point at(static_cast<int>(std::lround(cell.x())), static_cast<int>(std::lround(cell.y())));
  if (at.x < 0 || at.y < 0 || at.x >= patch.size().width || at.y >= patch.size().height) return std::nullopt;
  return at;
}

float step_between(const cv::Vec3f& a, const cv::Vec3f& b) {
  const cv::Vec3f step = a - b;
  return std::sqrt(step[0] * step[0] + kChromaPart * (step[1] * step[1] + step[2] * step[2]));
}

/// The contrast of the edge at a place of the curve, levels; nothing if the visible edge is not the body's.
std::optional<float> contrast_at(const Vector<2>& location, const Vector<2>& normal, const ColourPatch& patch,
                                 const cv::Mat& blocked) {
  const Vector<2> across = kReach * patch.step * normal;
  const auto inside = cell_at(patch, location - across), outside = cell_at(patch, location + across),
             here = cell_at(patch, location + patch.step * normal);
  if (!inside || !outside || !here) return std::nullopt;
  if (!blocked.empty() && std::max(blocked.at<float>(*here), blocked.at<float>(*outside)) > kTaken) return std::nullopt;
  const bool known = !patch.scene.empty() && patch.known.at<float>(*inside) >= 1 && patch.known.at<float>(*outside) >= 1;
  const float contrast = step_between(patch.colour.at<cv::Vec3f>(*inside), patch.colour.at<cv::Vec3f>(*outside));
  if (known && step_between(patch.scene.at<cv::Vec3f>(*inside), patch.scene.at<cv::Vec3f>(*outside)) > contrast / 3)
    return std::nullopt;  // much of the step is the scene's own
  return contrast > kAlike ? std::optional(contrast) : std::nullopt;
}

bool is_at_border(const Vector<2>& location, cv::Size image) {
  return location.x() < kBorderBand - 0.5 || location.y() < kBorderBand - 0.5 || location.x() > image.width - 0.5 - kBorderBand ||
         location.y() > image.height - 0.5 - kBorderBand;
}

}  // namespace

std::vector<int> at_border(const geometry::ClosedSpline& spline, cv::Size image) {
  std::vector<int> hidden;
  for (int i = 0; i < spline.count(); ++i) {
    if (is_at_border(spline.at(i), image)) hidden.push_back(i);
  }
  return hidden;
}

VisibleEdge visible_edge(const geometry::ClosedSpline& spline, const ColourPatch& patch, const cv::Mat& blocked, cv::Size image,
                         double prior) {
  VisibleEdge edge;
  const double least = std::min(kMinDeviation, prior);
  for (int i = 0; i < spline.count(); ++i) {
    const Vector<2> location = spline.at(i);
    const auto normal = spline.normal(i);
    const auto contrast =
        normal && !is_at_border(location, image) ? contrast_at(location, *normal, patch, blocked) : std::optional<float>();
    if (!contrast) edge.hidden.push_back(i);
    edge.deviations.push_back(contrast ? std::clamp(kBlurredNoise / *contrast, least, prior) : prior);
  }
  return edge;
}

}  // namespace marey::track::contour::colour

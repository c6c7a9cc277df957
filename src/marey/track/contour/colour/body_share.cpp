// A cell is a mixture of body and ground: its share of body is how far its colour is from the ground's on the line to the body's.
// The ground is read beside the silhouette; the body in the middle of the limb that the cell belongs to, because skin between two
// white garments is not a half of white. A halo is ground that is too bright or too dark: it lies beyond the ground, or a small
// part of the line to the body; blur and smeared colour are symmetric, so that the body ends halfway. How much
// too wide the silhouette is, is measured where body and ground differ clearly; deeper than that, a cell belongs to the body
// whatever its colour, unless it plainly is ground and leads outside (between legs, below an arm). Without that measurement,
// limbs whose colour is near to the ground's are cut off. Cost: some ten box filters, and a few dozen reads per cell at the edge.
#include "marey/track/contour/colour/body_share.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <opencv2/imgproc.hpp>

namespace marey::track::contour::colour {
namespace {

constexpr double kGroundReach = 0.15;                    // heights: the neighbourhood that the ground is read from
constexpr double kAway = 0.025;                          // heights: the ground is read this far from everything
constexpr double kRim = 0.07, kMinRim = 5, kMaxRim = 8;  // heights; px: how deep a silhouette's rim may be ground
constexpr float kMinContrast = 16;                       // levels between body and ground, from which on colour is reliable
constexpr float kClearContrast = 32;                     // from which on it shows how much too wide a silhouette is
constexpr double kSpread = 0.5;                          // cells by which that varies along the edge
constexpr float kPlainGround = 12;                       // levels from the ground below which a cell deep inside is ground
constexpr float kHalo = 0.25F;                           // square of a halo's strength, of the step from ground to body
constexpr float kLightChange = 40;                       // levels; a cell farther from the scene is shadow or a target
constexpr double kSmooth = 0.6;                          // cells

int odd_kernel(double radius) {
  return 2 * std::max(1, static_cast<int>(std::lround(radius))) + 1;
}

cv::Mat dilated(const cv::Mat& mask, double radius) {
  cv::Mat result;
  const int size = odd_kernel(radius);
  cv::dilate(mask, result, cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}));
  return result;
}

/// Mean of the colours about each cell with these weights; if there are no weights, `otherwise`.
cv::Mat weighted_mean(const cv::Mat& colour, const cv::Mat& weights, int size, const cv::Scalar& otherwise) {
  cv::Mat sums(colour.size(), CV_32FC4);
  const auto fallback =
      cv::Vec3f(static_cast<float>(otherwise[0]), static_cast<float>(otherwise[1]), static_cast<float>(otherwise[2]));
  for (int y = 0; y < colour.rows; ++y) {
    const auto* in = colour.ptr<cv::Vec3f>(y);
    const float* weight = weights.ptr<float>(y);
    auto* out = sums.ptr<cv::Vec4f>(y);
    for (int x = 0; x < colour.cols; ++x) out[x] = {weight[x] * in[x][0], weight[x] * in[x][1], weight[x] * in[x][2], weight[x]};
  }
  cv::boxFilter(sums, sums, -1, {size, size}, {-1, -1}, true, cv::BORDER_CONSTANT);
  cv::Mat mean(colour.size(), CV_32FC3);
  for (int y = 0; y < colour.rows; ++y) {
    const auto* in = sums.ptr<cv::Vec4f>(y);
    auto* out = mean.ptr<cv::Vec3f>(y);
    for (int x = 0; x < colour.cols; ++x) {
      constexpr float kLittle = 1e-3F;  // of the weight: the fallback's, so that it fades in; numerical
      const float all = in[x][3] + kLittle;
      for (int k = 0; k < 3; ++k) out[x][k] = (in[x][k] + kLittle * fallback[k]) / all;
    }
  }
  return mean;
}

/// Puts the scene in place of the colours beside where it is known, in the light of this frame: the mean difference of the cells
/// that nothing takes.
void use_scene(const ColourPatch& patch, const cv::Mat& free, cv::Mat& ground) {
  cv::Vec3f drift(0, 0, 0);
  float count = 0;
  for (int y = 0; y < free.rows; ++y) {
    for (int x = 0; x < free.cols; ++x) {
      if (free.at<float>(y, x) < 1 || patch.known.at<float>(y, x) < 1) continue;
      const cv::Vec3f off = patch.colour.at<cv::Vec3f>(y, x) - patch.scene.at<cv::Vec3f>(y, x);
      if (off.dot(off) > kLightChange * kLightChange) continue;
      drift += off;
      count += 1;
    }
  }
  if (count > 0) drift /= count;
  for (int y = 0; y < free.rows; ++y) {
    for (int x = 0; x < free.cols; ++x) {
      if (patch.known.at<float>(y, x) < 1) continue;
      ground.at<cv::Vec3f>(y, x) = patch.scene.at<cv::Vec3f>(y, x) + drift;
    }
  }
}

}  // namespace

cv::Mat ground_next_to(const ColourPatch& patch, const cv::Mat& taken, double height) {
  const cv::Mat away = dilated(taken, std::max(2.0, kAway * height) / patch.step);
  cv::Mat free = 1 - away;
  cv::Mat somewhere;
  free.convertTo(somewhere, CV_8U, 255);
  const cv::Scalar everywhere = cv::mean(patch.colour, cv::countNonZero(somewhere) > 0 ? somewhere : cv::Mat());
  cv::Mat around = weighted_mean(patch.colour, free, odd_kernel(kGroundReach * height / patch.step), everywhere);
  if (!patch.scene.empty()) use_scene(patch, free, around);
  return around;
}

namespace {

/// The colour of the body at a cell near it, read where the silhouette is deepest: inwards from the cell to the middle of the limb,
/// or until it is `rim` cells below the edge.
class BodyColours {
 public:
  BodyColours(const ColourPatch& patch, const cv::Mat& depth, float rim) : patch_(patch), depth_(depth), rim_(rim) {}

  cv::Vec3f at(cv::Point cell) const {
    const cv::Point middle = deepest_from(cell);
    const float minimum = 0.8F * depth_.at<float>(middle);
    cv::Vec3f sum(0, 0, 0);
    float count = 0;
    for_neighbours(middle, [&](const cv::Point& one) {
      if (depth_.at<float>(one) < minimum) return;
      sum += patch_.colour.at<cv::Vec3f>(one);
      count += 1;
    });
    return count > 0 ? sum / count : sum;
  }

 private:
  template <typename Visit>
  void for_neighbours(const cv::Point& cell, const Visit& visit) const {
    for (int y = std::max(0, cell.y - 1); y <= std::min(depth_.rows - 1, cell.y + 1); ++y) {
      for (int x = std::max(0, cell.x - 1); x <= std::min(depth_.cols - 1, cell.x + 1); ++x) visit({x, y});
    }
  }

  cv::Point deepest_from(cv::Point cell) const {
    while (depth_.at<float>(cell) < rim_) {
      cv::Point best = cell;
      for_neighbours(cell, [&](const cv::Point& one) {
        if (depth_.at<float>(one) > depth_.at<float>(best)) best = one;
      });
      if (best == cell) break;
      cell = best;
    }
    return cell;
  }

  const ColourPatch& patch_;
  const cv::Mat& depth_;
  float rim_;
};

/// How many cells too wide a silhouette is, from the shares of cells that are ground by their colour, ring by ring inwards.
class Overwidth {
 public:
  explicit Overwidth(float rim) : rings_(static_cast<std::size_t>(std::ceil(rim)) + 1) {}

  /// A cell `depth` > 0 cells below the edge, whose colour is decisive.
  void add(float depth, bool ground) {
    Ring& ring = rings_[std::min(rings_.size() - 1, static_cast<std::size_t>(std::max(0.0F, depth - 0.5F)))];
    ring.cells += 1;
    ring.ground += ground ? 1 : 0;
  }
  double cells() const {
    double sum = 0;
    for (const Ring& ring : rings_) sum += ring.cells > 0 ? static_cast<double>(ring.ground) / ring.cells : 0;
    return sum;
  }

 private:
  struct Ring {
    int cells = 0, ground = 0;
  };
  std::vector<Ring> rings_;
};

/// What the colours show of the cells near a body.
struct ColourFractions {
  cv::Mat covered;  ///< CV_32FC1: share of body; −1 where colour does not specify
  cv::Mat away;     ///< CV_32FC1: square of the difference from the ground, levels²
  double too_wide;  ///< cells
};

ColourFractions fractions_by_colour(const ColourPatch& patch, const cv::Mat& ground, const cv::Mat& near, const cv::Mat& depth,
                                    float rim) {
  const BodyColours body(patch, depth, rim);
  Overwidth overwidth(rim);
  ColourFractions fractions{cv::Mat(patch.size(), CV_32FC1, cv::Scalar(-1)), cv::Mat(patch.size(), CV_32FC1), 0};
  for (int y = 0; y < near.rows; ++y) {
    for (int x = 0; x < near.cols; ++x) {
      const cv::Vec3f away = patch.colour.at<cv::Vec3f>(y, x) - ground.at<cv::Vec3f>(y, x);
      const float square = away.dot(away), below = depth.at<float>(y, x);
      fractions.away.at<float>(y, x) = square;
      if (near.at<float>(y, x) == 0) continue;
      if (below > rim) {
        if (square < kPlainGround * kPlainGround) fractions.covered.at<float>(y, x) = 0;
        continue;
      }
      const cv::Vec3f difference = body.at({x, y}) - ground.at<cv::Vec3f>(y, x);
      const float contrast = difference.dot(difference);
      if (contrast < kMinContrast * kMinContrast) continue;
      const float covered = std::clamp(away.dot(difference) / contrast, 0.0F, 1.0F);
      // What is unlike both (dark hair over a white shirt) is body too; a halo is not as far from the ground as that.
      const bool unlike = covered < 0.5F && square > kHalo * contrast;
      if (below > 0 && contrast >= kClearContrast * kClearContrast) overwidth.add(below, covered < 0.5F && !unlike);
      if (!unlike) fractions.covered.at<float>(y, x) = covered;
    }
  }
  fractions.too_wide = overwidth.cells();
  return fractions;
}

}  // namespace

cv::Mat body_fraction(const ColourPatch& patch, const cv::Mat& own, double height) {
  cv::Mat taken, inside, depth;
  cv::max(own, patch.mask, taken);
  own.convertTo(inside, CV_8U, 255);
  cv::distanceTransform(inside, depth, cv::DIST_L2, 3);
  const auto rim = static_cast<float>(std::clamp(kRim * height, kMinRim, kMaxRim) / patch.step);
  const ColourFractions colour = fractions_by_colour(patch, ground_next_to(patch, taken, height), dilated(own, 1), depth, rim);
  cv::Mat fraction = own.clone();
  for (int y = 0; y < fraction.rows; ++y) {
    for (int x = 0; x < fraction.cols; ++x) {
      const float covered = colour.covered.at<float>(y, x);
      const bool deep = depth.at<float>(y, x) > colour.too_wide + kSpread;
      if (covered < 0 || (deep && colour.away.at<float>(y, x) >= kPlainGround * kPlainGround)) continue;
      fraction.at<float>(y, x) = covered;
    }
  }
  cv::GaussianBlur(fraction, fraction, {}, kSmooth);
  return fraction;
}

}  // namespace marey::track::contour::colour

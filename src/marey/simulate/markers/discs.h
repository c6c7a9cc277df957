#pragma once

#include <cstdint>
#include <span>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::simulate::markers {

/// A marker as a camera sees it: a disc of one brightness with a blurred edge. Its share of a point at distance d from the centre
/// is ½ erfc((d − radius) / (√2 · blur)).
struct Disc {
  Vector<2> centre = Vector<2>::Zero();  ///< px
  double radius = 2;                     ///< px
  double level = 202;                    ///< grey level of the disc itself; below the background for a dark one
  double blur = 0.55;                    ///< standard deviation of the edge, px; positive
};

/// The pixels that `draw_discs` touches for it, in an image without borders.
cv::Rect reach_of(const Disc& disc);

/// Lays discs over `image` (CV_32FC1), each over those before it: pixel ← (1 − c) · pixel + c · level, where the coverage c is the
/// disc's share averaged over points × points places within the pixel. Only pixels within 6 blurs of a disc are touched.
void draw_discs(cv::Mat& image, std::span<const Disc> discs, int points = 8);

/// Fills a box of `image` (CV_32FC1) with one level; pixels that the box covers in part are mixed.
void draw_barrier(cv::Mat& image, const Box& box, double level);

/// What the sensor gives: Gaussian noise of standard deviation `noise` grey levels added, rounded, and held within `depth`
/// (CV_8U or CV_16U). The same for the same seed.
cv::Mat expose(const cv::Mat& image, double noise, std::uint64_t seed, int depth = CV_8U);

/// The Cramér-Rao bound on the centre of a disc on a flat background: the smallest standard deviation, in px per axis, that any
/// unbiased estimator can reach which knows neither centre, radius, blur, level nor background. White noise of variance noise² +
/// 1/12 (rounding); the average over sub-pixel places. Derivatives of the rendered pixels are taken numerically.
double disc_centre_bound(const Disc& disc, double background, double noise);

}  // namespace marey::simulate::markers

// One frame against expectations: paint where the model's lines are expected, and clicks.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/calibrate/ptz/initial_tripod.h"
#include "marey/calibrate/ptz/line_markings.h"
#include "marey/calibrate/ptz/ptz_fit.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

struct Correction {
  AimFit fit;
  Paint paint;
  /// How much speaks for the aim: the agreeing samples, by their share of those that ought to be seen.
  double merit() const;
};

/// px at 1280 across: the standard deviation of an aim, whichever of turning and zooming is the larger.
double unsure_px(const Aim& aim);

/// Searches for paint twice: first as far about as the expectation is unsure, then close to what that says. `clicks` as
/// `click_sightings` gives them count besides; `lines` in the world, `luma` CV_8UC1.
Correction correct_aim(const cv::Mat& luma, const geometry::Tripod& tripod, std::span<const geometry::PitchLine> lines,
                       const Aim& expected, std::span<const PaintSighting> clicks, const AimOptions& options = {});

/// The paint that agrees with an aim, evenly chosen and at most `maximum`.
std::vector<PaintSighting> agreeing_paint(const std::vector<PaintSighting>& paint, const geometry::Tripod& tripod, const Aim& aim,
                                          cv::Size size, double cut_off, std::size_t maximum);

/// Of the lines of which `in_view` samples or more lie within the image, how many are there: at least the fraction `present` of
/// those samples agrees. 1 where no line has as many.
double lines_present(const Correction& detected, const geometry::Tripod& tripod, cv::Size size, double cut_off, int in_view,
                     double present);

/// Clicks as sightings of a place along each axis; `sigma` px.
std::vector<PaintSighting> click_sightings(std::span<const ClickedPosition> clicks, double sigma);

/// Where clicks alone aim the camera, beginning at `start`.
Aim aim_of_clicks(std::span<const PaintSighting> clicks, const geometry::Tripod& tripod, const geometry::Heading& start,
                  cv::Size size, const AimOptions& options = {});

/// The middle of the distances between clicks and where the camera sees their places, px.
double distance_from_clicks(std::span<const ClickedPosition> clicks, const geometry::Tripod& tripod,
                            const geometry::Heading& heading, cv::Size size);

}  // namespace marey::calibrate::ptz

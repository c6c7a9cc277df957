#include "marey/calibrate/ptz/ptz_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

constexpr double kLineStep = 0.5;        // m between samples of the model's lines
constexpr double kNarrowReach = 3.5;     // px at 1280: paint is searched for again where the first fit says
constexpr std::size_t kMaxKept = 90;     // sightings of a frame
constexpr int kMinExpected = 25;         // samples in view: with fewer, missing paint says nothing
constexpr double kKeyframeAngle = 0.07;  // rad: the angle between two keyframes,
constexpr double kKeyframeZoom = 0.2;    // or their ln f
constexpr double kFlowLost = 0.004;  // rad and ln f: how unsure a frame is whose image did not continue, where it may be a flash
constexpr std::size_t kMinForTripod = 40;  // sightings of a keyframe

SmoothOptions smooth_options(const TrackingOptions& options) {
  return {options.aim, options.flow_px, options.flow_zoom, options.moving_fraction};
}

/// Evenly chosen, at most this many.
std::vector<PaintSighting> thinned(const std::vector<PaintSighting>& paint, std::size_t maximum) {
  if (paint.size() <= maximum) return paint;
  std::vector<PaintSighting> kept;
  for (std::size_t i = 0; i < maximum; ++i) kept.push_back(paint[i * paint.size() / maximum]);
  return kept;
}

/// Those that agree with an aim.
std::vector<PaintSighting> agreeing(const std::vector<PaintSighting>& paint, const geometry::Tripod& tripod, const Aim& aim,
                                    cv::Size size, double cut_off) {
  const auto numbers = tripod.as_numbers();
  const Vector<3> rotated = aim.heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  std::vector<PaintSighting> kept;
  for (const PaintSighting& one : paint) {
    const Vector<2> pixel = geometry::to_pixel(frame.detected({one.ground.x(), one.ground.y(), 0}), size);
    const double off = one.normal.cast<double>().dot(pixel - one.pixel.cast<double>());
    if (std::abs(off) < 2 * cut_off * one.sigma) kept.push_back(one);
  }
  return kept;
}

}  // namespace

PtzTracker::PtzTracker(const geometry::Tripod& tripod, cv::Size size, const TrackingOptions& options)
    : tripod_(tripod),
      size_(size),
      options_(options),
      lines_(geometry::pitch_lines(options.pitch, kLineStep)),
      odometry_(size, options.odometry) {
  const Vector<2> middle = Vector<2>(options.pitch.length / 2, options.pitch.width / 2) - tripod.location.head<2>();
  last_ = {std::atan2(middle.x(), middle.y()), std::atan2(tripod.location.z(), middle.norm()), 1};
}

void PtzTracker::know(std::int64_t frame, const geometry::Heading& heading, const std::vector<ClickedPosition>& clicks) {
  known_.push_back({frame, heading, clicks});
}

double PtzTracker::unsure_px(const Matrix<3>& covariance, double log_focal) const {
  const double angle = std::exp(log_focal) * std::sqrt(covariance.topLeftCorner<2, 2>().trace()),
               zoom = std::sqrt(covariance(2, 2));
  return 640 * std::max(angle, 0.7 * zoom);
}

std::optional<Aim> PtzTracker::predicted(const std::optional<Rotated>& rotated) const {
  if (!aim_ || !rotated) return std::nullopt;
  const double scale = std::exp(rotated->log_focal - aim_->heading.log_focal);
  const Vector<3> step(scale * rotated->by.x(), scale * rotated->by.y(), rotated->by.z());
  return Aim{geometry::Heading::of(aim_->heading.as_vector() + step),
             aim_->covariance + flow_covariance(*rotated, aim_->heading.log_focal, smooth_options(options_))};
}

/// Paint twice: first as far about as the expectation is unsure, then close to what that says.
PtzTracker::Correction PtzTracker::corrected(const cv::Mat& luma, const Aim& expected) const {
  const double unit = size_.width / 1280.0;
  Correction result;
  PaintOptions how;
  how.reach = unit * std::clamp(4 + 3 * unsure_px(expected.covariance, expected.heading.log_focal), 5.0, 16.0);
  const Paint wide = find_paint(luma, tripod_, expected.heading, lines_, how);
  const AimFit first = solve_aim(tripod_, size_, wide.detected, expected, options_.aim);
  how.reach = unit * kNarrowReach;
  result.paint = find_paint(luma, tripod_, first.aim.heading, lines_, how);
  result.fit = solve_aim(tripod_, size_, result.paint.detected, expected, options_.aim);
  return result;
}

/// Whether what ought to be seen is there; a few frames without it are forgiven.
bool PtzTracker::plausible(const Correction& detected) {
  const bool missing =
      detected.paint.expected >= kMinExpected && detected.fit.agreeing < options_.fraction * detected.paint.expected;
  ambiguous_ = missing ? ambiguous_ + 1 : 0;
  return ambiguous_ < options_.patience &&
         unsure_px(detected.fit.aim.covariance, detected.fit.aim.heading.log_focal) < options_.unsure_px;
}

/// Where flow gave up and the image may be the next one all the same (a blurred pan, a flash): about where it was aimed last.
std::optional<Aim> PtzTracker::held(const cv::Mat& luma) const {
  if (!aim_) return std::nullopt;
  const Aim wide{aim_->heading, aim_->covariance + kFlowLost * kFlowLost * Matrix<3>::Identity()};
  const Correction detected = corrected(luma, wide);
  const bool there = detected.fit.agreeing >= options_.again.lowest_count && detected.fit.lines >= options_.again.lines &&
                     detected.fit.agreeing >= options_.again.fraction * detected.paint.expected;
  if (!there) return std::nullopt;
  return Aim{detected.fit.aim.heading, wide.covariance};
}

/// The frames before a loss, in which the lines were missing already.
void PtzTracker::forget_ambiguous() {
  const std::size_t first = records_.size() - std::min(records_.size(), static_cast<std::size_t>(ambiguous_));
  for (std::size_t i = first; i < records_.size(); ++i) records_[i].found.reset(), records_[i].paint.clear();
  ambiguous_ = waited_ = 0;
}

/// From clicks where the frame has some, else from the image alone, which is not tried for every frame.
std::optional<Aim> PtzTracker::from_scratch(const Image& image) {
  const auto index = static_cast<std::int64_t>(records_.size());
  for (const Known& known : known_) {
    if (known.frame == index) return Aim{known.heading, Vector<3>(4e-6, 4e-6, 4e-5).asDiagonal().toDenseMatrix()};
  }
  if (waited_++ % options_.inspect_again != 0) return std::nullopt;
  const auto found = find_again(image, tripod_, options_.pitch, lines_, options_.again);
  if (!found) return std::nullopt;
  ++result_.found_again;
  return Aim{found->aim.heading, Vector<3>(4e-6, 4e-6, 1e-4).asDiagonal().toDenseMatrix()};
}

void PtzTracker::add(const Image& image, double time_s) {
  TurnRecord record;
  record.time_s = time_s;
  record.rotated = odometry_.step(image.luma(), tripod_, aim_ ? aim_->heading : last_);
  if (!record.rotated && !records_.empty()) ++result_.cuts;
  std::optional<Aim> expected = predicted(record.rotated);
  if (!expected) expected = held(image.luma());
  if (!expected && aim_ && !records_.empty()) waited_ = 0;  // a cut: search immediately
  if (!expected) expected = from_scratch(image);
  aim_.reset();
  if (expected) {
    const Correction detected = corrected(image.luma(), *expected);
    if (plausible(detected)) {
      aim_ = detected.fit.aim;
      last_ = aim_->heading;
      record.found = aim_;
      record.paint = thinned(agreeing(detected.paint.detected, tripod_, *aim_, size_, options_.aim.cut_off), kMaxKept);
      if (detected.fit.agreeing > 0) medians_.push_back(static_cast<float>(detected.fit.median_px));
    } else {
      forget_ambiguous();
    }
  }
  records_.push_back(std::move(record));
  if (aim_) note_keyframe();
}

/// A frame that is aimed elsewhere than those before it is one more that the tripod is solved on.
void PtzTracker::note_keyframe() {
  if (keyframes_.size() >= options_.max_keyframes || records_.back().paint.size() < kMinForTripod) return;
  for (const Keyframe& one : keyframes_) {
    const Vector<3> off = one.heading.as_vector() - aim_->heading.as_vector();
    if (off.head<2>().norm() < kKeyframeAngle && std::abs(off.z()) < kKeyframeZoom) return;
  }
  keyframes_.push_back({records_.size() - 1, aim_->heading});
  refine_tripod(1);
}

void PtzTracker::refine_tripod(int rounds) {
  std::vector<TripodFrameSight> sights;
  for (const Keyframe& one : keyframes_) sights.push_back({one.heading, records_[one.record].paint, {}});
  for (const Known& one : known_) sights.push_back({one.heading, {}, one.clicks});
  for (int round = 0; round < rounds; ++round) {
    const TripodSolution solved = solve_tripod(tripod_, sights, size_, options_.tripod);
    if (!std::isfinite(solved.cost)) return;
    tripod_ = solved.tripod;
    for (std::size_t i = 0; i < sights.size(); ++i) sights[i].heading = solved.headings[i];
  }
  for (std::size_t i = 0; i < keyframes_.size(); ++i) keyframes_[i].heading = sights[i].heading;
  for (std::size_t i = 0; i < known_.size(); ++i) known_[i].heading = sights[keyframes_.size() + i].heading;
  if (aim_ && !keyframes_.empty() && keyframes_.back().record + 1 == records_.size()) aim_->heading = keyframes_.back().heading;
}

PtzResult PtzTracker::finish() {
  result_.camera.tripod = tripod_;
  const auto smooth = smooth_ptz(records_, tripod_, size_, smooth_options(options_));
  for (std::size_t i = 0; i < records_.size(); ++i) {
    PtzCamera::Turn& turn = result_.camera.rotations.emplace_back();
    turn.time_s = records_[i].time_s;
    const bool sure = smooth[i] && unsure_px(smooth[i]->covariance, smooth[i]->heading.log_focal) < options_.unsure_px;
    if (sure) {
      turn.heading = smooth[i]->heading;
      const double angle = options_.tripod_px / 640 * std::exp(-smooth[i]->heading.log_focal), zoom = options_.tripod_zoom;
      turn.covariance = smooth[i]->covariance + Vector<3>(angle * angle, angle * angle, zoom * zoom).asDiagonal().toDenseMatrix();
    }
    result_.lost += sure ? 0 : 1;
  }
  if (!medians_.empty()) {
    result_.median_px = geometry::median(medians_);
  }
  return result_;
}

}  // namespace marey::calibrate::ptz

#include "marey/calibrate/ptz/ptz_tracker.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "marey/calibrate/ptz/tripod_spread.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::ptz {
namespace {

constexpr double kLineStep = 0.5;        // m between samples of the model's lines
constexpr std::size_t kMaxKept = 90;     // sightings of a frame
constexpr int kMinExpected = 25;         // samples in view: with fewer, missing paint says nothing
constexpr double kKeyframeAngle = 0.07;  // rad: the angle between two keyframes,
constexpr double kKeyframeZoom = 0.2;    // or their ln f
constexpr double kFlowLost = 0.004;  // rad and ln f: how unsure a frame is whose image did not continue, where it may be a flash
constexpr std::size_t kMinForTripod = 40;  // sightings of a keyframe

SmoothOptions smooth_options(const TrackingOptions& options) {
  SmoothOptions smooth;
  smooth.aim = options.aim;
  smooth.flow_px = options.flow_px, smooth.flow_zoom = options.flow_zoom, smooth.moving_fraction = options.moving_fraction,
  smooth.moving_zoom = options.moving_zoom;
  return smooth;
}

}  // namespace

PtzTracker::PtzTracker(const geometry::Tripod& tripod, cv::Size size, const TrackingOptions& options)
    : tripod_(tripod),
      size_(size),
      options_(options),
      lines_(geometry::pitch_lines(options.pitch, kLineStep)),
      search_(lines_),
      odometry_(size, options.odometry) {
  const Vector<2> middle = Vector<2>(options.pitch.length / 2, options.pitch.width / 2) - tripod.location.head<2>();
  last_ = {std::atan2(middle.x(), middle.y()), std::atan2(tripod.location.z(), middle.norm()), 1};
}

void PtzTracker::know(std::int64_t frame, const geometry::Heading& heading, const std::vector<ClickedPosition>& clicks) {
  known_.push_back({frame, heading, clicks, {}});
}

void PtzTracker::prepare(std::int64_t frame, const cv::Mat& luma) {
  constexpr int kRounds = 3;  // numerical: the tripod by clicks alone leaves lines some pixels off
  for (int round = 0; round < kRounds; ++round) {
    for (Known& known : known_) {
      if (known.frame != frame) continue;
      const auto clicks = click_sightings(known.clicks, options_.tripod.click_px * size_.width / 1280.0);
      const Aim expected = aim_of_clicks(clicks, tripod_, known.heading, size_, options_.aim);
      const Correction detected = correct_aim(luma, tripod_, lines_, expected, clicks, options_.aim);
      known.paint.clear();
      if (!missing(detected) && detected.fit.lines > 0)
        known.paint = agreeing_paint(detected.paint.detected, tripod_, detected.fit.aim, size_, options_.aim.cut_off, kMaxKept);
    }
    refine_tripod(1);
  }
}

const PtzTracker::Known* PtzTracker::known_at(std::size_t frame) const {
  const auto known =
      std::find_if(known_.begin(), known_.end(), [&](const Known& one) { return one.frame == static_cast<std::int64_t>(frame); });
  return known == known_.end() ? nullptr : &*known;
}

std::vector<PaintSighting> PtzTracker::clicks_at(std::size_t frame) const {
  const Known* known = known_at(frame);
  if (known == nullptr) return {};
  return click_sightings(known->clicks, options_.tripod.click_px * size_.width / 1280.0);
}

Correction PtzTracker::corrected(const cv::Mat& luma, const Aim& expected, std::size_t frame) const {
  return correct_aim(luma, tripod_, lines_, expected, clicks_at(frame), options_.aim);
}

std::optional<Aim> PtzTracker::predicted(const std::optional<Rotated>& rotated) const {
  if (!aim_ || !rotated) return std::nullopt;
  return next_aim(*aim_, *rotated, smooth_options(options_));
}

/// Graphics over much of the image stand still while the camera turns: which group of corners goes with it, by the paint. Where
/// that does not decide, either may be right.
void PtzTracker::choose_corners(Rotated& rotated, const cv::Mat& luma, const geometry::Heading& last) {
  const auto merit = [&](const Vector<3>& by) {
    Rotated one = rotated;
    one.by = by;
    return correct_aim(luma, tripod_, lines_, *predicted(one), {}, options_.aim).merit();
  };
  const double as_given = merit(rotated.by), other = merit(*rotated.otherwise);
  if (other > options_.prefers * as_given)
    odometry_.prefer_other(rotated, last);
  else if (as_given <= options_.prefers * other)
    rotated.ambiguity = rotated.by - *rotated.otherwise;
}

bool PtzTracker::missing(const Correction& detected) const {
  if (detected.paint.expected < kMinExpected) return false;
  if (detected.fit.agreeing < options_.fraction * detected.paint.expected) return true;
  // One touchline along the whole image is most of the paint, and says nothing of the pan.
  const double present =
      lines_present(detected, tripod_, size_, options_.aim.cut_off, options_.line_in_view, options_.line_present);
  return present <= options_.lines_present;
}

/// Whether what ought to be seen is there; a few frames without it are forgiven.
bool PtzTracker::plausible(const Correction& detected) {
  ambiguous_ = missing(detected) ? ambiguous_ + 1 : 0;
  return ambiguous_ < options_.patience && unsure_px(detected.fit.aim) < options_.unsure_px;
}

/// Where flow gave up and the image may be the next one all the same (a blurred pan, a flash): about where it was aimed last.
std::optional<Aim> PtzTracker::held(const cv::Mat& luma) const {
  if (!aim_) return std::nullopt;
  const Aim wide{aim_->heading, aim_->covariance + kFlowLost * kFlowLost * Matrix<3>::Identity()};
  const Correction detected = correct_aim(luma, tripod_, lines_, wide, {}, options_.aim);
  const bool there = detected.fit.agreeing >= options_.again.min_agreeing && detected.fit.lines >= options_.again.lines &&
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

/// From the image alone, which is not tried for every frame.
std::optional<Aim> PtzTracker::found_in(const Image& image) {
  const int waited = waited_++;
  if (waited % options_.search_interval != 0) return std::nullopt;
  FindAgainOptions how = options_.again;
  how.everywhere = !lost_for_ || waited / options_.search_interval % options_.search_everywhere == 0;
  if (lost_for_) how.near = NearHeading{last_, *lost_for_};
  const auto found = find_again(image, tripod_, options_.pitch, lines_, search_, how);
  if (!found) return std::nullopt;
  ++result_.found_again;
  return Aim{found->aim.heading, Vector<3>(4e-6, 4e-6, 1e-4).asDiagonal().toDenseMatrix()};
}

/// A clicked frame's aim: its clicks and, where it does not contradict them, the expectation. Nothing if no camera on this
/// tripod sees the clicks where they are.
std::optional<Correction> PtzTracker::clicked(const cv::Mat& luma, const std::optional<Aim>& expected, bool& contradicts) const {
  const Known* known = known_at(records_.size());
  const double limit = options_.click_agrees * options_.tripod.click_px * size_.width / 1280.0;
  const Aim by_clicks = aim_of_clicks(clicks_at(records_.size()), tripod_, known->heading, size_, options_.aim);
  if (distance_from_clicks(known->clicks, tripod_, by_clicks.heading, size_) > limit) return std::nullopt;
  if (expected) {
    const Correction alone = correct_aim(luma, tripod_, lines_, *expected, {}, options_.aim);
    contradicts = distance_from_clicks(known->clicks, tripod_, alone.fit.aim.heading, size_) > limit;
    if (!contradicts) return corrected(luma, *expected, records_.size());
    const Correction other = corrected(luma, by_clicks, records_.size());
    contradicts = missing(alone) || alone.merit() < options_.image_over_clicks * other.merit();
    return contradicts ? other : alone;
  }
  return corrected(luma, by_clicks, records_.size());
}

void PtzTracker::keep(const cv::Mat& luma) {
  images_.push_back(luma.clone());
  const auto most = static_cast<std::size_t>(options_.kept_mb * 1e6 / static_cast<double>(luma.total()));
  while (images_.size() > std::max<std::size_t>(2, most)) images_.pop_front();
}

void PtzTracker::enter(TurnRecord& record, const Correction& detected, std::size_t frame) const {
  record.found = detected.fit.aim;
  record.paint = agreeing_paint(detected.paint.detected, tripod_, *record.found, size_, options_.aim.cut_off, kMaxKept);
  const std::vector<PaintSighting> clicks = clicks_at(frame);
  record.paint.insert(record.paint.end(), clicks.begin(), clicks.end());
}

void PtzTracker::add(const Image& image, double time_s) {
  const cv::Mat& luma = image.luma();
  const std::size_t frame = records_.size();
  TurnRecord record;
  record.time_s = time_s;
  const geometry::Heading before = aim_ ? aim_->heading : last_;
  record.rotated = odometry_.step(luma, tripod_, before);
  if (aim_ && record.rotated && record.rotated->otherwise) choose_corners(*record.rotated, luma, before);
  if (!record.rotated && !records_.empty()) ++result_.cuts;
  const bool was_known = aim_.has_value();
  std::optional<Aim> expected = predicted(record.rotated);
  if (!expected) expected = held(luma);
  bool contradicts = false, alone = false;
  std::optional<Correction> detected;
  const Known* known = known_at(frame);
  if (known != nullptr && (!known->clicks.empty() || !expected)) detected = clicked(luma, expected, contradicts);
  if (!detected && !expected) {
    if (was_known) waited_ = 0;  // a cut: search immediately
    if (!was_known && record.rotated && lost_for_) {
      last_ = geometry::Heading::of(last_.as_vector() + record.rotated->by);
      ++*lost_for_;
    } else if (!record.rotated) {
      lost_for_.reset();
    }
    expected = found_in(image);
    alone = expected.has_value();
  }
  if (!detected && expected) detected = corrected(luma, *expected, frame);
  if (detected && aim_ && record.rotated && !record.rotated->ambiguity.isZero()) {
    const Vector<3> by = detected->fit.aim.heading.as_vector() - aim_->heading.as_vector();
    if ((by - *record.rotated->otherwise).norm() < (by - record.rotated->by).norm())
      odometry_.prefer_other(*record.rotated, before);
  }
  aim_.reset();
  keep(luma);
  if (detected && plausible(*detected)) {
    aim_ = detected->fit.aim;
    last_ = aim_->heading, lost_for_ = 0;
    enter(record, *detected, frame);
    if (detected->fit.agreeing > 0) medians_.push_back(static_cast<float>(detected->fit.median_px));
  } else if (detected) {
    forget_ambiguous();
  }
  records_.push_back(std::move(record));
  if (aim_ && (contradicts || !was_known)) walk_back(alone ? options_.image_advantage : options_.click_advantage);
  if (aim_) note_keyframe(records_.size() - 1);
}

void PtzTracker::set_ambiguous(std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    result_.ambiguous_frames += records_[i].found ? 1 : 0;
    records_[i].found.reset(), records_[i].paint.clear();
  }
}

/// From the last frame to those before it, until it meets the same aim there.
void PtzTracker::walk_back(double advantage) {
  const std::size_t kept_from = records_.size() - images_.size();
  Aim after = *records_.back().found;
  int missed = 0;
  for (std::size_t k = records_.size() - 1; k-- > kept_from;) {
    TurnRecord& record = records_[k];
    if (!records_[k + 1].rotated) return;
    const cv::Mat& luma = images_[k - kept_from];
    const Correction detected = corrected(luma, previous_aim(after, *records_[k + 1].rotated, smooth_options(options_)), k);
    missed = missing(detected) ? missed + 1 : 0;
    if (missed >= options_.patience || unsure_px(detected.fit.aim) > options_.unsure_px) {
      for (std::size_t i = k + 1; i < k + static_cast<std::size_t>(missed); ++i)
        records_[i].found.reset(), records_[i].paint.clear();
      return;
    }
    if (record.found) {
      if (same_aim(*record.found, detected.fit.aim, smooth_options(options_))) return;
      const Correction other = corrected(luma, *record.found, k);
      if (detected.merit() < advantage * other.merit()) {
        const auto about = static_cast<std::size_t>(options_.contact_about);
        records_[k + 1].rotated.reset();
        set_ambiguous(k > about ? k - about : 0, std::min(records_.size() - 1, k + about));
        return;
      }
      std::erase_if(keyframes_, [&](const Keyframe& one) { return one.record == k; });
    }
    enter(record, detected, k);
    note_keyframe(k);
    after = detected.fit.aim;
    if (!keyframes_.empty() && keyframes_.back().record == k) after.heading = keyframes_.back().heading;
  }
}

/// A frame that is aimed elsewhere than those before it is one more that the tripod is solved on.
void PtzTracker::note_keyframe(std::size_t index) {
  const TurnRecord& record = records_[index];
  if (keyframes_.size() >= options_.max_keyframes || record.paint.size() < kMinForTripod) return;
  for (const Keyframe& one : keyframes_) {
    const Vector<3> off = one.heading.as_vector() - record.found->heading.as_vector();
    if (off.head<2>().norm() < kKeyframeAngle && std::abs(off.z()) < kKeyframeZoom) return;
  }
  keyframes_.push_back({index, record.found->heading});
  refine_tripod(1);
}

void PtzTracker::refine_tripod(int rounds) {
  std::vector<TripodFrameSight> sights;
  for (const Keyframe& one : keyframes_) sights.push_back({one.heading, records_[one.record].paint, {}});
  for (const Known& one : known_) sights.push_back({one.heading, one.paint, one.clicks});
  for (int round = 0; round < rounds; ++round) {
    const TripodSolution solved = solve_tripod(tripod_, sights, size_, options_.tripod);
    if (!std::isfinite(solved.cost)) return;
    tripod_ = solved.tripod;
    tripod_covariance_ = solved.covariance;
    for (std::size_t i = 0; i < sights.size(); ++i) sights[i].heading = solved.headings[i];
  }
  for (std::size_t i = 0; i < keyframes_.size(); ++i) keyframes_[i].heading = sights[i].heading;
  for (std::size_t i = 0; i < known_.size(); ++i) known_[i].heading = sights[keyframes_.size() + i].heading;
  if (aim_ && !keyframes_.empty() && keyframes_.back().record + 1 == records_.size()) aim_->heading = keyframes_.back().heading;
}

/// Every clicked frame beside the result; what contradicts its clicks is lost, and what hangs together with it.
void PtzTracker::check_clicks(std::vector<std::optional<Aim>>& smooth) {
  const auto about = static_cast<std::size_t>(options_.click_about);
  const double limit = options_.click_agrees * options_.tripod.click_px * size_.width / 1280.0;
  for (const Known& known : known_) {
    if (known.clicks.empty()) continue;
    ClickCheck& check = result_.clicks.emplace_back();
    check.frame = known.frame;
    const auto at = static_cast<std::size_t>(known.frame);
    if (at >= smooth.size() || !smooth[at]) continue;
    check.off_px = distance_from_clicks(known.clicks, tripod_, smooth[at]->heading, size_);
    check.contradicts = *check.off_px > limit;
  }
  for (const ClickCheck& check : result_.clicks) {
    if (!check.contradicts) continue;
    const auto at = static_cast<std::size_t>(check.frame);
    const auto agrees = [&](std::size_t frame) {
      return std::any_of(result_.clicks.begin(), result_.clicks.end(), [&](const ClickCheck& other) {
        return other.frame == static_cast<std::int64_t>(frame) && other.off_px && !other.contradicts;
      });
    };
    const auto drop = [&](std::size_t frame) { result_.ambiguous_frames += smooth[frame] ? 1 : 0, smooth[frame].reset(); };
    for (std::size_t k = at; k > 0 && k + about > at && !agrees(k - 1) && records_[k].rotated; --k) drop(k - 1);
    for (std::size_t k = at + 1; k < smooth.size() && k < at + about && !agrees(k) && records_[k].rotated; ++k) drop(k);
    drop(at);
  }
}

PtzResult PtzTracker::finish() {
  aim_.reset();
  refine_tripod(2);
  result_.camera.tripod = tripod_;
  auto smooth = smooth_ptz(records_, tripod_, size_, smooth_options(options_));
  check_clicks(smooth);
  const auto spread = spread_of_tripod(records_, smooth, tripod_, tripod_covariance_, size_, smooth_options(options_));
  for (std::size_t i = 0; i < records_.size(); ++i) {
    PtzCamera::Turn& turn = result_.camera.rotations.emplace_back();
    turn.time_s = records_[i].time_s;
    const bool sure = smooth[i] && unsure_px(*smooth[i]) < options_.unsure_px;
    if (sure) {
      turn.heading = smooth[i]->heading;
      const double angle = options_.model_px / 640 * std::exp(-smooth[i]->heading.log_focal), zoom = options_.model_zoom;
      const Matrix<3> own =
          smooth[i]->covariance + Vector<3>(angle * angle, angle * angle, zoom * zoom).asDiagonal().toDenseMatrix();
      turn.covariance = own + spread[i].heading;
      turn.position_covariance = own + spread[i].location;
    }
    result_.lost += sure ? 0 : 1;
  }
  if (!medians_.empty()) result_.median_px = geometry::median(medians_);
  return result_;
}

}  // namespace marey::calibrate::ptz

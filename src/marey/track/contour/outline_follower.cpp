// The system of Arnaut & Costa with what it lacked. For each target and frame: the shape filter is predicted by the motion filter
// (the paper's equation), the outline is searched along lines normal to it, the lines correct the shape filter, and the centre and
// the growth of the corrected outline correct the motion filter.
//
// Beyond the paper: lines carry variances and must agree with the filter's own; targets nearer to the camera own their pixels, so
// that lines on a neighbour say nothing; a target of which too little is seen keeps its shape and coasts on its motion filter;
// one of which a part is hidden by the scene is held stiff; and an outline that left its target begins anew at the silhouette that
// the tracker says is the target's.
// Cost a frame: targets × (lines × (length of a line + (2M)²) + (2M)²); nothing is allocated once every target has been seen.
// References: Arnaut & Costa, TECCEN 2(1), 2009; MacCormick & Blake, IJCV 39(1), 2000; Blake & Isard, "Active Contours", 1998.
#include "marey/track/contour/outline_follower.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/body_share.h"
#include "marey/track/contour/colour_patch.h"
#include "marey/track/contour/followed_target.h"
#include "marey/track/contour/line_search.h"
#include "marey/track/contour/shared_outlines.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

using Finding = MeasurementLine::Finding;

// Noise, in heights of the target (px where it says so); each √second where it is a motion.
constexpr double kBend = 0.12, kTogether = 0.3, kStiff = 0.1;  // the last: of both, while a part may be hidden
constexpr double kAcceleration = 0.4, kGrowthDrift = 0.15;
constexpr double kGrowthNoise = 2;                             // 1/s, of the growth read off two outlines
constexpr double kGate = 3.5;                                  // standard deviations
constexpr double kLeastReachPx = 4, kMostReachHeights = 0.25;  // of a line: px; heights
constexpr double kSeen = 0.6, kPartly = 0.25;                  // shares of the lines found
constexpr double kHiddenShare = 0.75;  // of the foreground usual within the outline: below, the scene hides some of it
constexpr double kShareMemory = 0.05;
constexpr double kMostUnlike = 1.35;        // factor of a silhouette's size over the usual, from which on it is not believed
constexpr double kLeft = 0.5;               // heights from where the centre is predicted: the motion begins anew
constexpr int kRounds = 3;                  // of the fit, in every frame
constexpr double kExplained = 0.3;          // IoU of a detection that explains an outline
constexpr double kHintScore = 0.3;          // continues a track, begins none
constexpr double kGrowthDoubt = 0.5;        // 1/s
constexpr double kBeside = 0.2;             // heights about a silhouette that are looked at
constexpr double kLeastOfSilhouette = 0.5;  // of its area that is body; less, and colour cannot tell
constexpr int kHeldTooLong = 5;             // frames after which a shape that was held says little
constexpr double kMeets = 0.03;             // share of its box from which on another's box meets it
constexpr double kLearn = 0.1;              // what a frame alone counts in how a target looks
constexpr int kLearnEvery = 3;              // frames: its colours change little

Box bounds(std::span<const Vector<2>> polygon) {
  Vector<2> least = polygon[0], most = polygon[0];
  for (const Vector<2>& corner : polygon) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  return {least.x(), least.y(), most.x() - least.x(), most.y() - least.y()};
}

}  // namespace

class OutlineFollower::Implementation {
 public:
  explicit Implementation(const OutlineOptions& options) : options_(options), places_(options.lines) { check(options); }

  std::span<const Observation<2>> observe(const Frame& frame, const Foreground& foreground, std::span<const Detection> detections) {
    const double dt = now_ ? std::max(0.0, seconds(frame.time - *now_)) : 0.0;
    now_ = frame.time;
    picture_ = frame.picture;
    mask_ = foreground.mask;
    hints_.clear();
    for (FollowedTarget& target : targets_) {
      predict(target, dt);
      target.measured.reset();
    }
    const cv::Mat& mask = foreground.covered.empty() ? foreground.mask : foreground.covered;
    if (mask.empty()) return hints_;
    order_by_nearness();
    for (const int index : nearest_first_) observe(targets_[index], mask, dt);
    for (FollowedTarget& target : targets_) hint(target, detections);
    return hints_;
  }

  std::span<const Track<2>> attach(std::span<const Track<2>> tracks, std::span<const Detection> detections) {
    std::erase_if(targets_, [&](const FollowedTarget& target) {
      return std::none_of(tracks.begin(), tracks.end(), [&](const Track<2>& track) { return track.id == target.id; });
    });
    std::erase_if(first_seen_, [&](const auto& one) { return one.second.time != before_; });
    tracks_.assign(tracks.begin(), tracks.end());
    shared_.clear();
    for (const Track<2>& track : tracks_) {
      const Detection* raw = detection_of(track, detections);
      const Detection* seen = raw != nullptr && !raw->group && raw->box.height >= options_.least_height ? raw : nullptr;
      FollowedTarget* target = target_of(track.id);
      if (target == nullptr && seen != nullptr) begin(track.id, *seen);
      // Where another's box meets its own, a silhouette may hold pixels of both.
      const bool alone =
          target == nullptr || target->learned == 0 || !track.box || !has_colours() || !meets_another(track.id, *track.box);
      if (target != nullptr && seen != nullptr && alone && take_silhouette(*target, *seen, track)) continue;
      if (track.box && has_colours()) shared_.push_back({track.id, *track.box, raw != nullptr, raw != nullptr && raw->group});
    }
    divide_shared();
    for (Track<2>& track : tracks_) {
      FollowedTarget* target = target_of(track.id);
      if (target == nullptr) continue;
      const Detection* raw = detection_of(track, detections);
      if (track.box) bring_back(*target, track);
      if (target->measured) target->motion.correct_centre(target->measured->centre, target->measured->deviation);
      target->held = target->state == Outline::State::held ? target->held + 1 : 0;
      track.outline = report(*target, raw != nullptr && !raw->group ? raw : nullptr, track);
    }
    before_ = now_.value_or(Timestamp{});
    return tracks_;
  }

 private:
  struct Silhouette {
    geometry::ClosedSpline spline;
    Timestamp time;
  };

  /// A track that no silhouette of its own was seen of in this frame.
  struct Shared {
    TrackId id;
    Box box;
    bool observed = false, in_group = false;
  };

  static const Detection* detection_of(const Track<2>& track, std::span<const Detection> detections) {
    if (!track.observation || *track.observation >= std::ssize(detections)) return nullptr;
    return &detections[static_cast<std::size_t>(*track.observation)];
  }

  bool meets_another(TrackId id, const Box& box) const {
    return std::any_of(tracks_.begin(), tracks_.end(), [&](const Track<2>& other) {
      return other.id != id && other.box && geometry::intersection(box, *other.box).area() > kMeets * box.area();
    });
  }

  FollowedTarget* target_of(TrackId id) {
    const auto target = std::find_if(targets_.begin(), targets_.end(), [&](const FollowedTarget& one) { return one.id == id; });
    return target != targets_.end() ? &*target : nullptr;
  }

  bool has_colours() const { return picture_.luma().type() == CV_8UC1 && picture_.size() == mask_.size() && !mask_.empty(); }

  void predict(FollowedTarget& target, double dt) {
    const bool held = target.state == Outline::State::held;
    const double stiff = target.state == Outline::State::seen && !target.crowded ? 1 : kStiff;
    const double step = std::sqrt(dt) * target.height;
    const double growth = held ? 0 : std::clamp(dt * target.motion.growth(), -0.2, 0.2);
    const ShapeNoise noise{.bend = held ? 0 : kBend * stiff * step,
                           .together = held ? 0 : kTogether * stiff * step,
                           .shift = dt * target.motion.velocity_deviation().mean(),
                           .growth = held ? 0 : dt * target.motion.growth_deviation()};
    target.shape.predict(dt * target.motion.velocity(), growth, target.shape.spline().centroid(), noise);
    target.predicted = target.shape.spline();
    target.behind.clear();
    target.hidden.clear();
    target.motion.predict(dt, {.acceleration = kAcceleration * target.height, .growth = kGrowthDrift});
    target.box = target.shape.spline().box();
    polygon_ = target.shape.spline().polygon(4);
    target.footprint.fill(polygon_);
  }

  /// A person whose feet are lower in the picture stands nearer to the camera.
  void order_by_nearness() {
    nearest_first_.resize(targets_.size());
    for (std::size_t i = 0; i < targets_.size(); ++i) nearest_first_[i] = static_cast<int>(i);
    std::stable_sort(nearest_first_.begin(), nearest_first_.end(),
                     [&](int a, int b) { return targets_[a].box.bottom() > targets_[b].box.bottom(); });
  }

  void observe(FollowedTarget& target, const cv::Mat& mask, double dt) {
    others_.clear();
    target.crowded = false;
    const Box wide = grown(target.box, 2 + kMostReachHeights * target.height);
    for (const FollowedTarget& other : targets_) {
      if (&other == &target || geometry::intersection(other.box, wide).area() <= 0) continue;
      others_.push_back(&other.footprint);
      target.crowded = target.crowded || geometry::intersection(other.box, target.box).area() > 0;
    }
    target.share = foreground_share(target, mask);
    place_lines(target);
    const LineScene scene{mask, others_};
    int found = 0, askable = 0;
    for (std::size_t i = 0; i < target.lines.size(); ++i) {
      MeasurementLine& line = target.lines[i];
      search_line(line, scene, deviations_[i]);
      found += line.finding == Finding::found ? 1 : 0;
      askable += line.finding != Finding::outside ? 1 : 0;
    }
    correct(target, found, askable, dt);
  }

  void correct(FollowedTarget& target, int found, int askable, double dt) {
    const bool hidden = target.share < kHiddenShare * target.usual_share;
    const double part = askable > 0 ? static_cast<double>(found) / askable : 0;
    if (part < kPartly || target.share < 0.4 * target.usual_share) {
      target.state = Outline::State::held;
      return;
    }
    const double predicted_area = target.shape.spline().area();
    const ShapeFilter predicted = target.shape;
    int believed = 0;
    for (std::size_t i = 0; i < target.lines.size(); ++i) {
      MeasurementLine& line = target.lines[i];
      if (line.finding != Finding::found) continue;
      const double position = line.normal.dot(line.foot) + line.offset;
      if (target.shape.correct(weights_[i], line.normal, position, line.variance, kGate)) {
        ++believed;
      } else {
        line.finding = Finding::outlier;
      }
    }
    target.knotted = is_knotted(target.shape.spline());
    if (target.knotted) {  // no outline: the lines are believed as to where the target is, not as to its shape
      const Vector<2> shift = target.shape.spline().centroid() - predicted.spline().centroid();
      target.shape = predicted;
      target.shape.predict(shift, 0, target.shape.spline().centroid(), {});
    }
    target.state = believed >= kSeen * askable && !hidden && !target.knotted ? Outline::State::seen
                   : believed >= kPartly * askable                           ? Outline::State::partly
                                                                             : Outline::State::held;
    if (target.state == Outline::State::held) return;
    const bool clear = target.state == Outline::State::seen;
    const Matrix<2> P = target.shape.centroid_covariance();
    const Vector<2> gait = (clear ? 1 : kHiddenCentre) * target.height * Vector<2>(kGaitAcross, kGaitDown);
    const Vector<2> deviation = (P.diagonal() + gait.cwiseAbs2()).cwiseSqrt();
    const Vector<2> centre = target.shape.spline().centroid();
    target.measured = {centre, deviation};
    const double area = target.shape.spline().area();
    if (clear && dt > 0 && area > 0 && predicted_area > 0) {
      const double measured = target.motion.growth() + (std::sqrt(area / predicted_area) - 1) / dt;
      target.motion.correct_growth(measured, kGrowthNoise);
      target.usual_share += kShareMemory * (target.share - target.usual_share);
      target.height += kShareMemory * (target.shape.spline().box().height - target.height);
    }
  }

  static Box grown(const Box& box, double by) { return {box.left - by, box.top - by, box.width + 2 * by, box.height + 2 * by}; }

  /// Of the pixels that the target covers and no other does.
  double foreground_share(const FollowedTarget& target, const cv::Mat& mask) const {
    const Footprint& own = target.footprint;
    const int left = std::max(0, own.left()), right = std::min(mask.cols, own.left() + own.width());
    int covered = 0, filled = 0;
    for (int y = std::max(0, own.top()); y < std::min(mask.rows, own.top() + own.height()); ++y) {
      const std::uint8_t* pixels = mask.ptr<std::uint8_t>(y);
      const std::uint8_t* inside = own.row(y).data();
      for (int x = left; x < right; ++x) {
        const int one = inside[x - own.left()];
        covered += one;
        filled += one & (pixels[x] >> 7);
      }
    }
    return covered > 0 ? static_cast<double>(filled) / covered : 0;
  }

  void place_lines(FollowedTarget& target) {
    const geometry::ClosedSpline& spline = target.shape.spline();
    spline.evenly_spaced(places_);
    target.lines.clear();
    weights_.clear();
    deviations_.clear();
    for (const double place : places_) {
      const geometry::SplineWeights weights = geometry::spline_weights(spline.order(), spline.count(), place);
      Vector<2> at = Vector<2>::Zero(), slope = Vector<2>::Zero();
      for (int j = 0; j < spline.order(); ++j) {
        const Vector<2>& point = spline.control_points()[(weights.first + j) % spline.count()];
        at += weights.value[j] * point;
        slope += weights.derivative[j] * point;
      }
      const double length = slope.norm();
      if (!(length > 1e-6)) continue;
      const Vector<2> normal(slope.y() / length, -slope.x() / length);
      const double deviation = std::sqrt(std::max(0.0, target.shape.variance(weights, normal)));
      const double most = std::max(kLeastReachPx, kMostReachHeights * target.height);
      target.lines.push_back({.foot = at, .normal = normal, .reach = std::clamp(3 * deviation, kLeastReachPx, most)});
      weights_.push_back(weights);
      deviations_.push_back(deviation);
    }
  }

  void hint(FollowedTarget& target, std::span<const Detection> detections) {
    if (target.state != Outline::State::seen) return;
    const Box box = target.shape.spline().box();
    target.box = box;
    for (const Detection& detection : detections) {
      if (geometry::iou(detection.box, box) > kExplained || geometry::intersection(detection.box, box).area() > 0.6 * box.area())
        return;
    }
    const Vector<2> deviation = target.motion.centre_deviation();
    hints_.push_back({.value = box.centre(),
                      .covariance = Matrix<2>((deviation.cwiseAbs2() + Vector<2>::Constant(4)).asDiagonal()),
                      .score = kHintScore,
                      .box = box});
  }

  /// The outline of a silhouette that nobody shares: where its body ends, by its colours; without them, its edge of light.
  std::optional<geometry::ClosedSpline> fitted(const Detection& seen, const geometry::SplineFitOptions& options) {
    share_.release();
    if (!has_colours() || seen.outline.size() < 4) return fit_silhouette(seen, picture_.luma(), options);
    const double height = seen.box.height;
    patch_ = cut_patch(picture_, mask_, grown(bounds(seen.outline), 2 + kBeside * height), cell_step(height));
    if (patch_.colour.empty()) return fit_silhouette(seen, picture_.luma(), options);
    share_ = body_share(patch_, cells_within(seen.outline, patch_), height);
    const std::vector<Vector<2>> edge = half_level_curve(share_, patch_);
    if (geometry::polygon_area(edge) < kLeastOfSilhouette * geometry::polygon_area(seen.outline)) {
      share_.release();
      return fit_silhouette(seen, picture_.luma(), options);
    }
    auto spline = fit_curve(edge, options);
    if (!spline || geometry::intersection(spline->box(), seen.box).area() < 0.5 * seen.box.area()) return std::nullopt;
    return spline;
  }

  /// The tracker says that `seen`, which nobody shares, is this target: its whole edge tells more than the lines, which a leg that
  /// swings leaves behind. A silhouette unlike the target (cut, or grown by something else) is left to the lines.
  bool take_silhouette(FollowedTarget& target, const Detection& seen, const Track<2>& track) {
    const int count = target.shape.spline().count();
    const auto spline = fitted(seen, {.order = options_.order, .least = count, .most = count, .rounds = kRounds});
    if (!spline || spline->count() != count) return false;
    const double growth = std::sqrt(spline->area() / target.usual_area);
    const bool known = target.state == Outline::State::seen || target.learned > 0;
    if (known && target.held < kHeldTooLong && (growth < 1 / kMostUnlike || growth > kMostUnlike)) return false;
    const Vector<2> centre = spline->centroid();
    if ((centre - target.motion.centre()).norm() > kLeft * target.height) {
      target.motion = MotionFilter(centre, target.motion.velocity(), 0, kSilhouetteNoise, target.height, kGrowthDoubt);
    }
    target.shape = ShapeFilter(*spline, kSilhouetteNoise);
    target.state = Outline::State::seen;
    target.knotted = false;
    target.measured = {centre, Vector<2>::Constant(kSilhouetteNoise) + target.height * Vector<2>(kGaitAcross, kGaitDown)};
    target.usual_area += kShareMemory * (spline->area() - target.usual_area);
    if (track.box) target.tracked_height += kShareMemory * (track.box->height - target.tracked_height);
    learn(target, centre, track);
    return true;
  }

  /// How the target looks, from what was just seen of it alone.
  void learn(FollowedTarget& target, const Vector<2>& centre, const Track<2>& track) {
    if (track.box) {
      const Vector<2> off = (centre - track.box->centre()) / target.height;
      target.centre_in_box += (target.learned == 0 ? 1 : kLearn) * (off - target.centre_in_box);
    }
    if (share_.empty()) return;
    const double rate = std::max(kLearn, 1.0 / (target.learned + 1));
    if (target.learned % kLearnEvery == 0) target.body.learn_colours(patch_, share_, centre, target.height, rate);
    target.body.learn_coverage(patch_, share_, centre, target.height, rate);
    ++target.learned;
  }

  /// Targets that nobody saw alone, region by region: those whose boxes meet, and those that the detector says share theirs.
  void divide_shared() {
    for (const Shared& one : shared_) {
      if (target_of(one.id) != nullptr || one.box.height < options_.least_height) continue;
      if (one.in_group || (one.observed && meets_another(one.id, one.box))) begin_shared(one);
    }
    std::erase_if(shared_, [&](const Shared& one) { return target_of(one.id) == nullptr; });
    std::vector<bool> done(shared_.size(), false);
    for (std::size_t i = 0; i < shared_.size(); ++i) {
      if (done[i]) continue;
      done[i] = true;
      std::vector<std::size_t> members{i};
      for (std::size_t k = 0; k < members.size(); ++k) {
        for (std::size_t j = 0; j < shared_.size(); ++j) {
          if (done[j] || geometry::intersection(shared_[members[k]].box, shared_[j].box).area() <= 0) continue;
          done[j] = true;
          members.push_back(j);
        }
      }
      if (members.size() == 1 && !shared_[i].in_group) continue;  // hidden by the scene, or missed: the lines tell
      std::sort(members.begin(), members.end());
      std::vector<SharedTarget> targets;
      for (const std::size_t k : members) targets.push_back({target_of(shared_[k].id), shared_[k].box, shared_[k].observed});
      outline_shared_region(picture_, mask_, targets);
    }
  }

  /// The tracker holds that the target is somewhere else: the outline is moved there with its shape held.
  static geometry::ClosedSpline moved_to(const geometry::ClosedSpline& spline, const Vector<2>& centre) {
    std::vector<Vector<2>> points = spline.control_points();
    const Vector<2> shift = centre - spline.centroid();
    for (Vector<2>& point : points) point += shift;
    return {spline.order(), std::move(points)};
  }

  static void bring_back(FollowedTarget& target, const Track<2>& track) {
    const Vector<2> centre = target.motion.centre();
    const Box& box = *track.box;
    if (centre.x() >= box.left && centre.x() < box.right() && centre.y() >= box.top && centre.y() < box.bottom()) return;
    target.shape = ShapeFilter(moved_to(target.shape.spline(), box.centre()), kBend * target.height);
    target.motion = MotionFilter(box.centre(), track.velocity, 0, kBend * target.height, target.height, kGrowthDoubt);
    target.state = Outline::State::held;
    target.measured.reset();
    target.lines.clear();
  }

  /// From two consecutive silhouettes: v is the centre's shift, s the change of the mean distance from the centre to the control
  /// points (the paper takes one of them; MotionFilter's doubt covers what the legs add).
  void begin(TrackId id, const Detection& seen) {
    auto spline = fitted(seen, fit_options(options_));
    if (!spline) return;
    const auto first = first_seen_.find(id);
    if (first == first_seen_.end()) {
      first_seen_.emplace(id, Silhouette{std::move(*spline), *now_});
      return;
    }
    const double dt = seconds(*now_ - first->second.time);
    const geometry::ClosedSpline& before = first->second.spline;
    const Vector<2> centre = spline->centroid(), velocity = (centre - before.centroid()) / dt;
    const double growth = (std::sqrt(spline->area() / before.area()) - 1) / dt;
    const double height = seen.box.height;
    const double noise = std::sqrt(2) * (kSilhouetteNoise + kGaitAcross * height) / dt;
    MotionFilter motion(centre, velocity, 0, kSilhouetteNoise, noise, kGrowthDoubt);
    motion.correct_growth(growth, kGrowthNoise);
    add(id, std::move(*spline), motion, height);
    first_seen_.erase(first);
  }

  /// Of one that was never seen alone: a body that stands, as large as the tracker's box, shaped by the region's colours at once.
  void begin_shared(const Shared& shared) {
    geometry::SplineFitOptions options = fit_options(options_);
    if (!options_.control_points) options.least = options.most;  // its shape is not known yet
    const auto spline = standing_body(shared.box, options);
    if (!spline) return;
    const double height = shared.box.height;
    add(shared.id, *spline, MotionFilter(spline->centroid(), Vector<2>::Zero(), 0, kBend * height, height, kGrowthDoubt), height);
    targets_.back().held = kHeldTooLong;
    targets_.back().state = Outline::State::held;
    targets_.back().centre_in_box = (spline->centroid() - shared.box.centre()) / height;
  }

  void add(TrackId id, geometry::ClosedSpline spline, const MotionFilter& motion, double height) {
    const double area = spline.area();
    geometry::ClosedSpline predicted = spline;
    targets_.push_back({.id = id,
                        .shape = ShapeFilter(std::move(spline), kSilhouetteNoise),
                        .motion = motion,
                        .height = height,
                        .usual_area = area,
                        .tracked_height = height,
                        .predicted = std::move(predicted)});
    FollowedTarget& target = targets_.back();
    target.box = target.shape.spline().box();
    target.footprint.fill(target.shape.spline().polygon(4));
  }

  /// Nothing where what is known is no outline of a target of this size.
  std::shared_ptr<const Outline> report(FollowedTarget& target, const Detection* seen, const Track<2>& track) {
    const cv::Size picture = mask_.size();
    const Box own = track.box.value_or(target.box);
    if (!is_outline_of(target.shape.spline(), own, mask_.empty() ? nullptr : &picture)) {
      target.shape = ShapeFilter(moved_to(target.predicted, target.motion.centre()), kBend * target.height);
      target.state = Outline::State::held;
      target.lines.clear();
      if (!is_outline_of(target.shape.spline(), own, mask_.empty() ? nullptr : &picture)) return nullptr;
    }
    auto slot = std::find_if(target.slots.begin(), target.slots.end(),
                             [](const std::shared_ptr<Outline>& one) { return one && one.use_count() == 1; });
    if (slot == target.slots.end()) {
      slot = std::find(target.slots.begin(), target.slots.end(), nullptr);
      if (slot == target.slots.end()) slot = target.slots.begin();
      *slot = std::make_shared<Outline>();
    }
    Outline& outline = **slot;
    const geometry::ClosedSpline& spline = target.shape.spline();
    outline.order = spline.order();
    outline.control_points = spline.control_points();
    outline.deviations.resize(spline.count());
    for (int i = 0; i < spline.count(); ++i) outline.deviations[i] = target.shape.deviation(i);
    outline.centre = target.motion.centre();
    outline.velocity = target.motion.velocity();
    outline.scale_rate = target.motion.growth();
    outline.centre_deviation = target.motion.centre_deviation();
    outline.velocity_deviation = target.motion.velocity_deviation();
    outline.scale_rate_deviation = target.motion.growth_deviation();
    outline.silhouette = seen != nullptr ? std::optional(seen->centre) : std::nullopt;
    outline.lines = target.lines;
    outline.state = target.state;
    outline.behind = target.behind;
    outline.hidden = target.hidden;
    return *slot;
  }

  OutlineOptions options_;
  std::optional<Timestamp> now_;
  Picture picture_;  // of the frame last observed
  cv::Mat mask_;     // its foreground
  std::vector<Shared> shared_;
  ColourPatch patch_;  // of the silhouette last fitted, and what of it is body; empty where colours were not used
  cv::Mat share_;
  Timestamp before_{};  // of the last frame attached
  std::vector<FollowedTarget> targets_;
  std::map<TrackId, Silhouette> first_seen_;  // targets seen once, in the last frame
  std::vector<Observation<2>> hints_;
  std::vector<Track<2>> tracks_;
  // What a frame needs, kept so that it is allocated once.
  std::vector<int> nearest_first_;
  std::vector<const Footprint*> others_;
  std::vector<double> places_, deviations_;
  std::vector<geometry::SplineWeights> weights_;
  std::vector<Vector<2>> polygon_;
};

OutlineFollower::OutlineFollower(const OutlineOptions& options) : self_(std::make_unique<Implementation>(options)) {}
OutlineFollower::~OutlineFollower() = default;
OutlineFollower::OutlineFollower(OutlineFollower&&) noexcept = default;
OutlineFollower& OutlineFollower::operator=(OutlineFollower&&) noexcept = default;

std::span<const Observation<2>> OutlineFollower::observe(const Frame& frame, const Foreground& foreground,
                                                         std::span<const Detection> detections) {
  return self_->observe(frame, foreground, detections);
}

std::span<const Track<2>> OutlineFollower::attach(std::span<const Track<2>> tracks, std::span<const Detection> detections) {
  return self_->attach(tracks, detections);
}

}  // namespace marey::track::contour

// The system of Arnaut & Costa with what it lacked. Each target is predicted and corrected by measurement lines
// (line_correction.h); then the tracker says who was seen where: an unshared silhouette is taken whole
// (lone_silhouette.h), a region that several share is divided among them (shared_outlines.h), and an outline that left its target
// is brought back (outline_report.h). Targets, and regions, are independent of each other within a step, and are processed on
// several threads; what decides about all of them runs before and after, on one. Reference: Arnaut & Costa, TECCEN 2(1), 2009.
#include "marey/track/contour/contour_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include "marey/core/geometry.h"
#include "marey/geometry/bspline.h"
#include "marey/track/contour/colour/colour_patch.h"
#include "marey/track/contour/contour_target.h"
#include "marey/track/contour/line_correction.h"
#include "marey/track/contour/lone_silhouette.h"
#include "marey/track/contour/outline_report.h"
#include "marey/track/contour/shared_outlines.h"
#include "marey/track/contour/silhouette_spline.h"

namespace marey::track::contour {
namespace {

constexpr double kExplained = 0.3;     // IoU of a detection that explains an outline
constexpr double kHintScore = 0.3;     // continues a track, begins none
constexpr double kSceneMargin = 0.15;  // heights: physical, a walker's step in a frame of 7 Hz and an arm
constexpr double kMeets = 0.03;        // share of its box from which on another's box meets it

}  // namespace

class ContourTracker::Implementation {
 public:
  explicit Implementation(const OutlineOptions& options) : options_(options), lines_(options.lines), lone_(fit_options(options)) {
    check(options);
  }

  std::span<const Observation<2>> observe(const Frame& frame, const Foreground& foreground, std::span<const Detection> detections) {
    const double dt = now_ ? std::max(0.0, seconds(frame.time - *now_)) : 0.0;
    now_ = frame.time;
    image_ = frame.image;
    mask_ = foreground.mask;
    lone_.inspect_at(image_, mask_, &scene_);
    const cv::Mat& mask = foreground.covered.empty() ? foreground.mask : foreground.covered;
    tbb::parallel_invoke([&] { learn_scene(); }, [&] { correct_by_lines(mask, dt); });
    hints_.clear();
    if (mask.empty()) return hints_;
    for (ContourTarget& target : targets_) hint(target, detections);
    return hints_;
  }

  std::span<const Track<2>> attach(std::span<const Track<2>> tracks, std::span<const Detection> detections) {
    std::erase_if(targets_, [&](const ContourTarget& target) {
      return std::none_of(tracks.begin(), tracks.end(), [&](const Track<2>& track) { return track.id == target.id; });
    });
    std::erase_if(first_observed_, [&](const auto& one) { return one.second.time != before_; });
    tracks_.assign(tracks.begin(), tracks.end());
    request_masks();
    take_silhouettes(detections);
    shared_.clear();
    for (std::size_t i = 0; i < tracks_.size(); ++i) {
      const Track<2>& track = tracks_[i];
      const Detection* raw = detection_of(track, detections);
      const Detection* detected = silhouette_of(track, detections);
      if (detected != nullptr && target_of(track.id) == nullptr) begin(track.id, *detected);
      if (taken_[i] == 0 && track.box && lone_.has_colours())
        shared_.push_back({track.id, *track.box, raw != nullptr, raw != nullptr && raw->group});
    }
    divide_shared();
    for (Track<2>& track : tracks_) {
      ContourTarget* target = target_of(track.id);
      if (target == nullptr) continue;
      const Detection* raw = detection_of(track, detections);
      if (track.box) bring_back(*target, track, raw);
      if (target->measured) target->motion.correct_centre(target->measured->centre, target->measured->deviation);
      target->held = target->state == Outline::State::held ? target->held + 1 : 0;
      track.outline = report(*target, raw != nullptr && !raw->group ? raw : nullptr, track, mask_.size());
    }
    before_ = now_.value_or(Timestamp{});
    return tracks_;
  }

  void use_masks(colour::FindBodyMasks find) { find_masks_ = std::move(find); }

 private:
  /// From what lies beyond all targets, as the tracker had them in the frame before: between two frames no person leaves that
  /// margin.
  void learn_scene() {
    target_boxes_.clear();
    for (const Track<2>& track : tracks_) {
      if (track.box) target_boxes_.push_back(colour::grown(*track.box, kSceneMargin * track.box->height));
    }
    scene_.observe(image_, mask_, target_boxes_);
  }

  /// The targets' filters are predicted, then corrected: a target reads where the others were predicted, and changes itself alone.
  void correct_by_lines(const cv::Mat& mask, double dt) {
    const auto each = [&](const auto& change) {
      tbb::parallel_for(std::size_t{0}, targets_.size(), [&](std::size_t i) { change(lines_.local(), targets_[i]); });
    };
    each([&](LineCorrection& lines, ContourTarget& target) {
      lines.predict(target, dt);
      target.measured.reset();
    });
    if (mask.empty()) return;
    each([&](LineCorrection& lines, ContourTarget& target) { lines.correct(target, targets_, mask, dt); });
  }

  /// Of each track whether its target took the outline of an unshared silhouette (`taken_`).
  void take_silhouettes(std::span<const Detection> detections) {
    taken_.assign(tracks_.size(), 0);
    tbb::parallel_for(
        std::size_t{0}, tracks_.size(),
        [&](std::size_t i) {
          const Track<2>& track = tracks_[i];
          const Detection* detected = silhouette_of(track, detections);
          ContourTarget* target = target_of(track.id);
          if (target == nullptr || detected == nullptr) return;
          // Where another's box meets its own, a silhouette may hold pixels of both.
          const bool alone = target->learned == 0 || !track.box || !lone_.has_colours() || !meets_another(track.id, *track.box);
          taken_[i] = alone && lone_.take(*target, *detected, track, mask_of(track.id)) ? 1 : 0;
        },
        tbb::simple_partitioner());
  }

  /// A network's masks of all targets whose box is known.
  void request_masks() {
    masks_.clear();
    if (!find_masks_ || !lone_.has_colours()) return;
    std::vector<Box> boxes;
    std::vector<TrackId> ids;
    for (const Track<2>& track : tracks_) {
      if (!track.box || track.box->height < options_.min_height) continue;
      boxes.push_back(*track.box);
      ids.push_back(track.id);
    }
    std::vector<colour::BodyMask> found = find_masks_(image_, boxes);
    for (std::size_t i = 0; i < ids.size() && i < found.size(); ++i) masks_.emplace(ids[i], std::move(found[i]));
  }

  const colour::BodyMask* mask_of(TrackId id) const {
    const auto mask = masks_.find(id);
    return mask != masks_.end() && !mask->second.chance.empty() ? &mask->second : nullptr;
  }

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

  /// The track's silhouette if no other person shares it and it is large enough; null: none.
  const Detection* silhouette_of(const Track<2>& track, std::span<const Detection> detections) const {
    const Detection* raw = detection_of(track, detections);
    return raw != nullptr && !raw->group && raw->box.height >= options_.min_height ? raw : nullptr;
  }

  bool meets_another(TrackId id, const Box& box) const {
    return std::any_of(tracks_.begin(), tracks_.end(), [&](const Track<2>& other) {
      return other.id != id && other.box && geometry::intersection(box, *other.box).area() > kMeets * box.area();
    });
  }

  ContourTarget* target_of(TrackId id) {
    const auto target = std::find_if(targets_.begin(), targets_.end(), [&](const ContourTarget& one) { return one.id == id; });
    return target != targets_.end() ? &*target : nullptr;
  }

  void hint(ContourTarget& target, std::span<const Detection> detections) {
    if (target.state != Outline::State::detected) return;
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

  /// Targets that were not observed alone, region by region: those whose boxes meet, and those that the detector says share theirs.
  void divide_shared() {
    for (const Shared& one : shared_) {
      if (target_of(one.id) != nullptr || one.box.height < options_.min_height) continue;
      if (one.in_group || (one.observed && meets_another(one.id, one.box))) begin_shared(one);
    }
    std::erase_if(shared_, [&](const Shared& one) { return target_of(one.id) == nullptr; });
    std::vector<std::vector<SharedTarget>> regions = shared_regions();
    tbb::parallel_for(
        std::size_t{0}, regions.size(), [&](std::size_t i) { outline_shared_region(image_, mask_, &scene_, regions[i]); },
        tbb::simple_partitioner());
  }

  /// Those of `shared_` whose boxes meet, directly or by others.
  std::vector<std::vector<SharedTarget>> shared_regions() {
    std::vector<std::vector<SharedTarget>> regions;
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
      if (members.size() == 1 && !shared_[i].in_group) continue;  // hidden by the scene, or missed: the lines decide
      std::sort(members.begin(), members.end());
      std::vector<SharedTarget>& targets = regions.emplace_back();
      for (const std::size_t k : members)
        targets.push_back({target_of(shared_[k].id), shared_[k].box, shared_[k].observed, mask_of(shared_[k].id)});
    }
    return regions;
  }

  /// From two consecutive silhouettes: v is the centre's shift, s the change of the mean distance from the centre to the control
  /// points (the paper takes one of them; MotionFilter's doubt covers what the legs add).
  void begin(TrackId id, const Detection& detected) {
    auto spline = lone_.fitted(detected, fit_options(options_));
    if (!spline) return;
    const auto first = first_observed_.find(id);
    if (first == first_observed_.end()) {
      first_observed_.emplace(id, Silhouette{std::move(*spline), *now_});
      return;
    }
    const double dt = seconds(*now_ - first->second.time);
    const geometry::ClosedSpline& before = first->second.spline;
    const Vector<2> centre = spline->centroid(), velocity = (centre - before.centroid()) / dt;
    const double growth = (std::sqrt(spline->area() / before.area()) - 1) / dt;
    const double height = detected.box.height;
    const double noise = std::sqrt(2) * (kSilhouetteNoise + kGaitAcross * height) / dt;
    MotionFilter motion(centre, velocity, 0, kSilhouetteNoise, noise, kGrowthAmbiguity);
    motion.correct_growth(growth, kGrowthNoise);
    add(id, std::move(*spline), motion, height);
    first_observed_.erase(first);
  }

  /// Of one that was never seen alone: a body that stands, as large as the tracker's box, shaped by the region's colours at once.
  void begin_shared(const Shared& shared) {
    geometry::SplineFitOptions options = fit_options(options_);
    if (!options_.control_points) options.minimum = options.maximum;  // its shape is not known yet
    const auto spline = standing_body(shared.box, options);
    if (!spline) return;
    const double height = shared.box.height;
    add(shared.id, *spline, MotionFilter(spline->centroid(), Vector<2>::Zero(), 0, kBend * height, height, kGrowthAmbiguity),
        height);
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
                        .typical_area = area,
                        .tracked_height = height,
                        .predicted = std::move(predicted)});
    ContourTarget& target = targets_.back();
    target.box = target.shape.spline().box();
    target.footprint.fill(target.shape.spline().polygon(4));
  }

  OutlineOptions options_;
  std::optional<Timestamp> now_;
  Image image_;   // of the frame last observed
  cv::Mat mask_;  // its foreground
  std::vector<Shared> shared_;
  tbb::enumerable_thread_specific<LineCorrection> lines_;  // what one correction needs, kept so that it is allocated once
  LoneSilhouettes lone_;
  colour::SceneImage scene_;
  colour::FindBodyMasks find_masks_;           // empty: no network is asked
  std::map<TrackId, colour::BodyMask> masks_;  // of this frame
  Timestamp before_{};                         // of the last frame attached
  std::vector<ContourTarget> targets_;
  std::map<TrackId, Silhouette> first_observed_;  // targets seen once, in the last frame
  std::vector<Observation<2>> hints_;
  std::vector<Track<2>> tracks_;
  std::vector<char> taken_;        // of each track of this frame
  std::vector<Box> target_boxes_;  // of the frame before, with a margin
};

ContourTracker::ContourTracker(const OutlineOptions& options) : self_(std::make_unique<Implementation>(options)) {}
ContourTracker::~ContourTracker() = default;
ContourTracker::ContourTracker(ContourTracker&&) noexcept = default;
ContourTracker& ContourTracker::operator=(ContourTracker&&) noexcept = default;

void ContourTracker::use_masks(colour::FindBodyMasks find) {
  self_->use_masks(std::move(find));
}

std::span<const Observation<2>> ContourTracker::observe(const Frame& frame, const Foreground& foreground,
                                                        std::span<const Detection> detections) {
  return self_->observe(frame, foreground, detections);
}

std::span<const Track<2>> ContourTracker::attach(std::span<const Track<2>> tracks, std::span<const Detection> detections) {
  return self_->attach(tracks, detections);
}

}  // namespace marey::track::contour

#include "marey/calibrate/people/people_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/calibrate/incremental_rig.h"
#include "marey/calibrate/people/clock_drift.h"
#include "marey/calibrate/people/image_people.h"
#include "marey/calibrate/people/people_growth.h"
#include "marey/calibrate/people/people_pairs.h"
#include "marey/calibrate/people/people_views.h"
#include "marey/calibrate/people/people_world.h"
#include "marey/calibrate/rays.h"
#include "marey/calibrate/wand/wand_lens.h"
#include "marey/calibrate/world_frame.h"
#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::people {
namespace {

constexpr double kLikelyFocal = 0.9;         // unswept: the same, where people are compared
constexpr double kFocalPrior = 0.5;          // unswept: relative, of the last adjustment
constexpr double kFocalOfTwo = 0.1;          // unswept: the same where two cameras alone see it
constexpr double kEqualLenses = 0.01;        // unswept: relative, between cameras of one make
constexpr double kNotWorse = 1.1;            // unswept: noise, times that of free lenses
constexpr double kDistortionPrior = 0.05;    // unswept: of the first radial term
constexpr std::size_t kMaxPoints = 6000;     // numerical, time against precision: in the last adjustment
constexpr std::size_t kOffsetPoints = 1200;  // numerical, time against precision: while offsets are found
constexpr int kOffsetRounds = 12;            // numerical, time against precision: at most
constexpr double kOffsetFound = 0.02;        // numerical, time against precision: frames by which none moves any more
constexpr double kDriftAfter = 60;           // by definition: s of a recording, in which 50 ppm are 3 ms
constexpr double kAssumedHeight = 1.75;      // by definition: m, where neither height nor distance is given
constexpr double kPoorlyKnown = 0.02;        // by definition: of the distances, a camera's deviation that is said

class PeopleCalibration {
 public:
  PeopleCalibration(const PeopleInput& input, const PeopleOptions& options, const Hooks& hooks)
      : in_(input), options_(options), hooks_(hooks) {
    result_.rig = input.rig;
  }

  PeopleRig run() {
    check_input();
    match();
    step("relating the cameras");
    rows_ = views_.rows();
    growth_ = grow_by_people(views_, in_.rig, rows_, options_.seed);
    fit();
    put_into_world();
    store();
    return std::move(result_);
  }

 private:
  std::size_t cameras() const { return in_.cameras.size(); }
  const RigCamera& rig_camera(std::size_t c) const { return in_.rig.cameras[c]; }
  void step(std::string_view what) { hooks_.advance({what, steps_++, std::nullopt}); }

  void check_input() const;
  void match();
  void check_mirrored(const PeopleMatch& matched) const;
  void fill(bundle::Bundle& bundle);
  void fit();
  bool drifts() const;
  double correct_clocks(const bundle::BundleResult& fitted);
  bundle::BundleResult adjust_until_still(const bundle::BundleOptions& how);
  void prefer_equal_lenses(bundle::BundleOptions how);
  std::vector<Body3> whole_people();
  void put_into_world();
  void store();
  void report_cameras();

  const PeopleInput& in_;
  const PeopleOptions& options_;
  const Hooks& hooks_;
  std::int64_t steps_ = 0;
  PeopleRig result_;
  PeopleViews views_;
  std::vector<PointRow> rows_;
  std::vector<std::size_t> row_of_body_;         // of the bundle
  std::vector<double> drift_, drift_deviation_;  // of each camera's clock, relative; 0: as its rate says
  Growth growth_;
  bundle::Bundle bundle_;
  bundle::BundleResult fitted_;
};

void PeopleCalibration::check_input() const {
  std::vector<std::string> without;
  for (std::size_t c = 0; c < cameras(); ++c) {
    if (!rig_camera(c).size)
      throw Error("camera \"{}\": the size of its images is not known; add size = [width, height]", rig_camera(c).name);
    if (in_.cameras[c].sequence.frames.empty()) without.push_back(rig_camera(c).name);
  }
  if (cameras() < 2) throw Error("{}", "one camera alone has no place beside others: two are needed");
  if (!without.empty()) throw Error("no person is in any image of {}", fmt::join(without, ", "));
}

void PeopleCalibration::match() {
  step("comparing people");
  for (std::size_t c = 0; c < cameras(); ++c) {
    const RigCamera& camera = rig_camera(c);
    std::optional<double> stated;
    if (const auto& focal_px = in_.cameras[c].focal_px; focal_px && !camera.lens)
      stated = *focal_px / std::max(camera.size->width, camera.size->height);
    views_.cameras.push_back({.people = image_people(in_.cameras[c].sequence, in_.cameras[c].rate_hz),
                              .rate_hz = in_.cameras[c].rate_hz,
                              .offset_s = camera.offset_s.value_or(0),
                              .offset_known = camera.offset_s.has_value(),
                              .lens = Camera(wand::starting_lens(camera, stated.value_or(kLikelyFocal)), Rigid3{}, *camera.size),
                              .stated_focal = stated});
    if (views_.cameras.back().people.empty())
      throw Error("camera \"{}\": no person is followed for half a second; let people walk where all cameras see them",
                  camera.name);
  }
  PeopleMatch matched = match_people(views_.cameras, options_.max_offset_s, options_.seed);
  check_mirrored(matched);
  views_.offsets_s = std::move(matched.offsets_s);
  views_.identity = std::move(matched.identity);
  result_.people = views_.people = matched.people;
  if (matched.people == 0)
    throw Error(
        "{}",
        "no person is seen by two cameras at the same time, as far as their motion says: let one person walk through the whole "
        "volume, and turn, where the cameras see the body from head to feet; people who stand still do not show how cameras' "
        "clocks differ");
}

/// Throws Error for a camera whose people are found in others if its image is mirrored, as those of phones' front cameras are.
void PeopleCalibration::check_mirrored(const PeopleMatch& matched) const {
  const auto has_people = [](const std::vector<int>& identity) {
    return std::any_of(identity.begin(), identity.end(), [](int person) { return person >= 0; });
  };
  for (std::size_t c = 0; c < cameras(); ++c) {
    if (has_people(matched.identity[c])) continue;
    std::vector<CameraPeople> turned = views_.cameras;
    turned[c].people = mirrored(std::move(turned[c].people), in_.cameras[c].sequence.set, rig_camera(c).size->width);
    if (!has_people(match_people(turned, options_.max_offset_s, options_.seed).identity[c])) continue;
    throw Error(
        "camera \"{}\": its images are mirrored, as a phone's front camera shows them: use the back camera, or mirror the "
        "video (ffmpeg -i IN.mp4 -vf hflip OUT.mp4)",
        rig_camera(c).name);
  }
}

void PeopleCalibration::fill(bundle::Bundle& bundle) {
  bundle.bodies.clear();
  bundle.observations.clear();
  row_of_body_.clear();
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    const PointRow& row = rows_[r];
    std::vector<SightLine> rays;
    const int body = static_cast<int>(bundle.bodies.size());
    std::vector<bundle::BundleObservation> seen;
    for (std::size_t c = 0; c < cameras(); ++c) {
      const auto at = views_.pixel(row, c);
      if (!at) continue;
      const auto before = views_.pixel(row, c, -2), after = views_.pixel(row, c, 2);
      const Vector<2> velocity =
          before && after ? Vector<2>((*after - *before) * views_.cameras[c].rate_hz / 4) : Vector<2>(Vector<2>::Zero());
      const bundle::BundleCamera& camera = bundle.cameras[c];
      const Camera view(camera.lens, camera.camera_from_world, *rig_camera(c).size);
      const auto ray = view.ray(*at);
      if (!ray) continue;
      rays.push_back({*ray});
      seen.push_back({static_cast<int>(c), body, 0, *at, velocity});
    }
    const auto meet = intersection_point(rays);
    if (!meet) continue;
    row_of_body_.push_back(r);
    bundle.bodies.emplace_back(*meet);
    bundle.observations.insert(bundle.observations.end(), seen.begin(), seen.end());
  }
}

/// Adjusts all; where offsets are free, points are taken again at the instants that they name.
void PeopleCalibration::fit() {
  step("adjusting everything");
  bundle_ = growth_.bundle;
  drift_.assign(cameras(), 0);
  drift_deviation_.assign(cameras(), 0);
  const std::vector<PointRow> all = some_of(rows_, kMaxPoints), whole = some_instants(rows_, kMaxPoints);
  bool first = true;
  for (bundle::BundleCamera& camera : bundle_.cameras) {
    const auto c = static_cast<std::size_t>(&camera - bundle_.cameras.data());
    camera.refine_pose = !first;
    if (!rig_camera(c).lens) {
      const std::optional<double>& stated = views_.cameras[c].stated_focal;
      camera.freedom = {stated ? kStatedFocal : cameras() > 2 ? kFocalPrior : kFocalOfTwo, 0, 0, {kDistortionPrior}};
      camera.known = wand::starting_lens(rig_camera(c), stated.value_or(kLikelyFocal));
    }
    camera.refine_offset = !first && options_.max_offset_s > 0 && !rig_camera(c).offset_s;
    first = false;
  }
  bundle::BundleOptions how;
  how.noise_px = std::max(1.0, growth_.fit.noise_px);
  how.outlier_sigmas = 4;
  rows_ = some_of(all, kOffsetPoints);
  fitted_ = adjust_until_still(how);
  how.noise_px = std::max(0.5, fitted_.noise_px);
  prefer_equal_lenses(how);
  rows_ = all;
  if (drifts()) adjust_until_still(how);
  fill(bundle_);
  fitted_ = bundle::adjust(bundle_, how);
  if (fitted_.inliers < kMinShared * static_cast<int>(cameras()) / 2)
    throw Error("only {} views of people's points fit together: let one person walk through the whole volume, and turn",
                fitted_.inliers);
  rows_ = whole;
}

/// Round by round, points taken again at the instants that the offsets name, until none moves.
bundle::BundleResult PeopleCalibration::adjust_until_still(const bundle::BundleOptions& how) {
  bundle::BundleOptions now = how;
  now.deviations = false;
  for (int round = 1;; ++round) {
    stop_point();
    fill(bundle_);
    bundle::BundleResult fitted = bundle::adjust(bundle_, now);
    now.noise_px = std::max(0.5, fitted.noise_px);
    double moved = 0;  // frames
    for (std::size_t c = 0; c < cameras(); ++c) {
      moved = std::max(moved, std::abs(bundle_.cameras[c].offset_s) * views_.cameras[c].rate_hz);
    }
    if (drifts()) moved = std::max(moved, correct_clocks(fitted));
    for (std::size_t c = 0; c < cameras(); ++c) views_.offsets_s[c] += std::exchange(bundle_.cameras[c].offset_s, 0);
    if (moved < kOffsetFound || round == kOffsetRounds) return fitted;
  }
}

/// Whether clocks' drifts are found: their offsets are, and people are there for long enough.
bool PeopleCalibration::drifts() const {
  return options_.max_offset_s > 0 && !rows_.empty() && rows_.back().time_s - rows_.front().time_s > kDriftAfter;
}

/// Corrects the rates of cameras whose offsets are free; the largest change of a time, in frames.
double PeopleCalibration::correct_clocks(const bundle::BundleResult& fitted) {
  std::vector<double> times;
  for (const std::size_t row : row_of_body_) times.push_back(rows_[row].time_s);
  const double end = std::max(std::abs(rows_.front().time_s), std::abs(rows_.back().time_s));
  double moved = 0;
  const auto corrections = clock_corrections(bundle_, fitted, times, drift_);
  for (std::size_t c = 0; c < cameras(); ++c) {
    const ClockCorrection& more = corrections[c];
    // Frame k at k / rate + offset goes to (1 + drift) of that, and the offset.
    views_.offsets_s[c] += more.drift * views_.offsets_s[c] + more.offset_s;
    views_.cameras[c].rate_hz /= 1 + more.drift;
    drift_[c] += more.drift;
    drift_deviation_[c] = more.deviation;
    moved = std::max(moved, (std::abs(more.drift) * end + std::abs(more.offset_s)) * views_.cameras[c].rate_hz);
  }
  return moved;
}

/// Cameras whose lenses are unknown and whose images are of one size are mostly of one make: body points that a network sees where
/// they are not move a focal length by more than two such lenses differ. Their lenses are kept near the median one, unless that
/// explains the points worse.
void PeopleCalibration::prefer_equal_lenses(bundle::BundleOptions how) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> makes;
  for (std::size_t c = 0; c < cameras(); ++c) {
    if (rig_camera(c).lens) continue;
    const auto [low, high] = std::minmax(rig_camera(c).size->width, rig_camera(c).size->height);
    makes[{low, high}].push_back(c);
  }
  const bundle::Bundle before = bundle_;
  const PeopleViews views = views_;
  const std::vector<double> drift = drift_;
  bool any = false;
  for (const auto& [size, of_make] : makes) {
    if (of_make.size() < 2) continue;
    std::vector<double> focals;
    for (const std::size_t c : of_make) focals.push_back(geometry::focal_of(bundle_.cameras[c].lens).x());
    const double focal = geometry::median(std::move(focals));
    for (const std::size_t c : of_make) {
      const double longer = std::max(rig_camera(c).size->width, rig_camera(c).size->height);
      bundle_.cameras[c].known = wand::starting_lens(rig_camera(c), focal / longer);
      bundle_.cameras[c].freedom.focal = kEqualLenses;
    }
    any = true;
  }
  if (!any) return;
  const bundle::BundleResult equal = adjust_until_still(how);
  if (equal.noise_px <= kNotWorse * fitted_.noise_px) {
    result_.notes.push_back(
        "cameras with images of one size are taken to have nearly the same focal length; where they have not, give "
        "their lenses in a rig file");
    return;
  }
  bundle_ = before;
  views_ = views;
  drift_ = drift;
}

/// Whole people by the cameras that were found: the points of the adjustment are too few of each to stand up in a long recording.
std::vector<Body3> PeopleCalibration::whole_people() {
  bundle::Bundle bundle = bundle_;
  for (bundle::BundleCamera& camera : bundle.cameras) camera.refine_pose = camera.refine_offset = false, camera.freedom = {};
  fill(bundle);
  bundle::BundleOptions how;
  how.noise_px = std::max(0.5, fitted_.noise_px);
  how.deviations = false;
  const bundle::BundleResult placed = bundle::adjust(bundle, how);
  std::map<std::pair<int, double>, Body3> bodies;
  const std::size_t points = in_.cameras.front().sequence.set.points.size();
  for (std::size_t i = 0; i < bundle.observations.size(); ++i) {
    const bundle::BundleObservation& detected = bundle.observations[i];
    const PointRow& row = rows_[row_of_body_[static_cast<std::size_t>(detected.body)]];
    Body3& body = bodies[{row.person, row.time_s}];
    if (body.points.empty()) body = {row.person, row.time_s, std::vector<std::optional<Vector<3>>>(points)};
    if (placed.inlier[i]) body.points[row.point] = bundle::marker_position(bundle, detected);
  }
  std::vector<Body3> in_order;
  for (auto& [key, body] : bodies) in_order.push_back(std::move(body));
  return in_order;
}

void PeopleCalibration::put_into_world() {
  const auto world = world_of(whole_people(), in_.cameras.front().sequence.set);
  if (!world)
    throw Error("{}",
                "no person's shoulders, ankles and eyes are seen by two cameras together: the vertical and the scale "
                "cannot be known");
  double scale = kAssumedHeight / world->height;
  if (options_.distance) {
    std::array<Vector<3>, 2> ends;
    for (std::size_t k = 0; k < 2; ++k) {
      const std::string& name = k == 0 ? options_.distance->first : options_.distance->second;
      const auto found =
          std::find_if(in_.rig.cameras.begin(), in_.rig.cameras.end(), [&](const RigCamera& c) { return c.name == name; });
      if (found == in_.rig.cameras.end()) throw Error("--distance: there is no camera \"{}\"", name);
      ends[k] = bundle_.cameras[static_cast<std::size_t>(found - in_.rig.cameras.begin())].camera_from_world.inverse().translation;
    }
    scale = options_.distance->metres / (ends[0] - ends[1]).norm();
  } else if (options_.height) {
    scale = *options_.height / world->height;
  } else {
    result_.notes.push_back(
        fmt::format("the scale is not known: the person was taken to be {:.2f} m tall; give --height, or --distance of two cameras",
                    kAssumedHeight));
  }
  result_.height = scale * world->height;
  move(bundle_, world->moved_from_world, scale);
  for (bundle::CameraDeviation& deviation : fitted_.deviations) deviation.centre *= scale;
}

void PeopleCalibration::report_cameras() {
  std::vector<std::string> names;
  std::vector<cv::Size> sizes;
  for (const RigCamera& camera : in_.rig.cameras) names.push_back(camera.name), sizes.push_back(*camera.size);
  result_.report = report_on(bundle_, fitted_, names, sizes);
  double extent = 0;
  for (const bundle::BundleCamera& a : bundle_.cameras) {
    for (const bundle::BundleCamera& b : bundle_.cameras)
      extent = std::max(extent, (a.camera_from_world.inverse().translation - b.camera_from_world.inverse().translation).norm());
  }
  for (std::size_t c = 0; c < cameras(); ++c) {
    if (std::abs(drift_[c]) > 2 * drift_deviation_[c])
      result_.notes.push_back(fmt::format("camera \"{}\": its clock is {:.0f} ± {:.0f} ppm {}: its rate is {:.5f} Hz", names[c],
                                          1e6 * std::abs(drift_[c]), 1e6 * drift_deviation_[c], drift_[c] > 0 ? "slow" : "fast",
                                          views_.cameras[c].rate_hz));
    const double sigma = fitted_.deviations.empty() ? 0 : fitted_.deviations[c].centre.norm();
    if (sigma > extent)
      throw Error(
          "camera \"{}\": its place does not follow from the people's points: it is known to {:.1f} m, and no two cameras are more "
          "than {:.1f} m apart; let one person walk through the whole volume, near and far, and turn",
          names[c], sigma, extent);
    if (sigma > kPoorlyKnown * extent)
      result_.notes.push_back(
          fmt::format("camera \"{}\": its place is known to {:.0f} cm; walk nearer to it, and through more of its image", names[c],
                      100 * sigma));
  }
}

void PeopleCalibration::store() {
  report_cameras();
  for (std::size_t c = 0; c < cameras(); ++c) {
    RigCamera& camera = result_.rig.cameras[c];
    camera.lens = bundle_.cameras[c].lens;
    camera.camera_from_world = bundle_.cameras[c].camera_from_world;
    camera.offset_s = views_.offsets_s[c] + bundle_.cameras[c].offset_s;
    if (drift_[c] != 0) camera.rate_hz = views_.cameras[c].rate_hz;
    camera.rms_px = result_.report.cameras[c].fit.rms_px;
  }
  const FitQuality& all = result_.report.all;
  result_.rig.calibration = Rig::Calibration{"people", all.mean_px, all.rms_px, all.inliers, all.observations, std::nullopt};
}

}  // namespace

PeopleRig calibrate_people(const PeopleInput& input, const PeopleOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  return PeopleCalibration(input, options, hooks).run();
}

}  // namespace marey::calibrate::people

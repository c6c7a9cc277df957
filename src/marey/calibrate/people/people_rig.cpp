#include "marey/calibrate/people/people_rig.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/calibrate/grow_rig.h"
#include "marey/calibrate/people/image_people.h"
#include "marey/calibrate/people/people_pairs.h"
#include "marey/calibrate/people/people_world.h"
#include "marey/calibrate/rays.h"
#include "marey/calibrate/wand/wand_lens.h"
#include "marey/calibrate/world_frame.h"
#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::people {
namespace {

constexpr std::array kFocalGuesses = {0.65, 0.9, 1.25, 1.75};  // unswept: of the longer side
constexpr double kLikelyFocal = 0.9;                           // unswept: the same, where people are compared
constexpr double kFocalPrior = 0.5;                            // unswept: relative, of the last adjustment
constexpr double kFocalOfTwo = 0.1;                            // unswept: the same where two cameras alone see it
constexpr double kEqualLenses = 0.01;                          // unswept: relative, between cameras of one make
constexpr double kNotWorse = 1.1;                              // unswept: noise, times that of free lenses
constexpr double kDistortionPrior = 0.05;                      // unswept: of the first radial term
constexpr std::size_t kGrownPoints = 160;    // numerical, time against precision: a camera, by which the rig grows
constexpr std::size_t kMaxPoints = 6000;     // numerical, time against precision: in the last adjustment
constexpr std::size_t kOffsetPoints = 1200;  // numerical, time against precision: while offsets are found
constexpr double kMaxGrid_hz = 30;           // numerical, time against precision
constexpr int kOffsetRounds = 12;            // numerical, time against precision: at most
constexpr double kOffsetFound = 0.02;        // numerical, time against precision: frames by which none moves any more
constexpr double kNoiseFactor = 1.5;         // unswept: times what the points state
constexpr double kAssumedHeight = 1.75;      // by definition: m, where neither height nor distance is given
constexpr int kMinShared = 40;               // unswept: points that link two cameras
constexpr double kPoorlyKnown = 0.02;        // by definition: of the distances, a camera's deviation that is said

/// A point of a person at an instant.
struct PointRow {
  int person = 0;
  double time_s = 0;
  std::size_t point = 0;
};

class PeopleCalibration {
 public:
  PeopleCalibration(const PeopleInput& input, const PeopleOptions& options, const Hooks& hooks)
      : in_(input), options_(options), hooks_(hooks), offsets_(input.cameras.size(), 0) {
    result_.rig = input.rig;
  }

  PeopleRig run() {
    check_input();
    match();
    grow();
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
  std::vector<PointRow> rows() const;
  std::optional<Vector<2>> pixel(const PointRow& row, std::size_t camera, double later_frames) const;
  void grow();
  void fill(bundle::Bundle& bundle);
  void fit();
  bundle::BundleResult adjust_until_still(const bundle::BundleOptions& how);
  void prefer_equal_lenses(bundle::BundleOptions how);
  void put_into_world();
  void store();
  void report_cameras();

  const PeopleInput& in_;
  const PeopleOptions& options_;
  const Hooks& hooks_;
  std::int64_t steps_ = 0;
  PeopleRig result_;
  std::vector<CameraPeople> people_;
  std::vector<std::vector<int>> identity_;
  std::vector<double> offsets_;
  std::vector<PointRow> rows_;
  std::vector<std::size_t> row_of_body_;  // of the bundle
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
    people_.push_back({.people = image_people(in_.cameras[c].sequence, in_.cameras[c].rate_hz),
                       .rate_hz = in_.cameras[c].rate_hz,
                       .offset_s = camera.offset_s.value_or(0),
                       .offset_known = camera.offset_s.has_value(),
                       .lens = Camera(wand::starting_lens(camera, kLikelyFocal), Rigid3{}, *camera.size)});
    if (people_.back().people.empty())
      throw Error("camera \"{}\": no person is followed for half a second; let people walk where all cameras see them",
                  camera.name);
  }
  PeopleMatch matched = match_people(people_, options_.max_offset_s, options_.seed);
  offsets_ = std::move(matched.offsets_s);
  identity_ = std::move(matched.identity);
  result_.people = matched.people;
  if (matched.people == 0)
    throw Error(
        "{}",
        "no person is seen by two cameras at the same time, as far as their motion says: let one person walk through the whole "
        "volume, and turn, where the cameras see the body from head to feet; people who stand still do not show how cameras' "
        "clocks differ");
}

std::optional<Vector<2>> PeopleCalibration::pixel(const PointRow& row, std::size_t camera, double later_frames) const {
  const CameraPeople& one = people_[camera];
  const double frame = (row.time_s - offsets_[camera]) * one.rate_hz + later_frames;
  for (std::size_t p = 0; p < one.people.size(); ++p) {
    if (identity_[camera][p] != row.person) continue;
    if (auto found = one.people[p].at(frame, row.point)) return found;
  }
  return std::nullopt;
}

/// All points at even instants that two cameras show, by time.
std::vector<PointRow> PeopleCalibration::rows() const {
  double begin = std::numeric_limits<double>::infinity(), end = -begin, rate_hz = 0;
  std::size_t points = 0;
  for (std::size_t c = 0; c < cameras(); ++c) {
    rate_hz = std::max(rate_hz, people_[c].rate_hz);
    points = std::max(points, in_.cameras[c].sequence.set.points.size());
    for (const ImagePerson& person : people_[c].people) {
      begin = std::min(begin, static_cast<double>(person.first) / people_[c].rate_hz + offsets_[c]);
      end = std::max(end, static_cast<double>(person.end()) / people_[c].rate_hz + offsets_[c]);
    }
  }
  const double step_s = 1 / std::min(kMaxGrid_hz, rate_hz);
  std::vector<PointRow> found;
  for (double time = begin; time < end; time += step_s) {
    for (int person = 0; person < result_.people; ++person) {
      for (std::size_t i = 0; i < points; ++i) {
        const PointRow row{person, time, i};
        int seen_by = 0;
        for (std::size_t c = 0; c < cameras(); ++c) seen_by += pixel(row, c, 0) ? 1 : 0;
        if (seen_by >= 2) found.push_back(row);
      }
    }
  }
  return found;
}

/// At most `maximum` of them, evenly spread, in an order that takes times and points in turn.
std::vector<PointRow> some_of(const std::vector<PointRow>& rows, std::size_t maximum) {
  if (rows.size() <= maximum) return rows;
  std::vector<PointRow> some;
  for (std::size_t k = 0; k < maximum; ++k) some.push_back(rows[(2 * k + 1) * rows.size() / (2 * maximum)]);
  return some;
}

void PeopleCalibration::grow() {
  step("relating the cameras");
  rows_ = rows();
  const std::vector<PointRow> some = some_of(rows_, kGrownPoints * cameras());
  wand::WandTable table;
  std::size_t required = 0;
  for (const PointRow& row : some) {
    auto& entries = table.emplace_back(cameras());
    for (std::size_t c = 0; c < cameras(); ++c) {
      if (const auto at = pixel(row, c, 0)) entries[c] = wand::Marks{*at}, ++required;
    }
  }
  std::vector<std::string> names;
  for (const RigCamera& camera : in_.rig.cameras) names.push_back(camera.name);
  const auto shared = shared_views(table, cameras());
  for (std::size_t c = 0; c < cameras(); ++c) {
    int most = 0;
    for (std::size_t other = 0; other < cameras(); ++other) most = std::max(most, other == c ? 0 : shared[c][other]);
    if (most < kMinShared)
      throw Error(
          "camera \"{}\" and another camera never show one person at the same time: let people walk where both see them, or check "
          "that it recorded at the same time",
          names[c]);
  }
  double best = std::numeric_limits<double>::infinity();
  const bool any_unknown = std::any_of(in_.rig.cameras.begin(), in_.rig.cameras.end(), [](const RigCamera& c) { return !c.lens; });
  for (const double guess : kFocalGuesses) {
    if (!any_unknown && guess != kFocalGuesses.front()) break;
    stop_point();
    std::vector<wand::WandCamera> grown;
    for (std::size_t c = 0; c < cameras(); ++c) {
      std::vector<double> sigmas;
      for (const ImagePerson& person : people_[c].people) sigmas.push_back(person.sigma_px);
      const RigCamera& camera = rig_camera(c);
      bundle::LensFreedom freedom;
      if (!camera.lens) freedom.focal = 0.3;
      grown.push_back(
          {camera.name, wand::starting_lens(camera, guess), *camera.size, freedom, kNoiseFactor * geometry::median(sigmas)});
    }
    try {
      Growth growth = grow_rig(grown, wand::WandShape{}, table, options_.seed);
      double noise = 0;
      for (const wand::WandCamera& camera : grown) noise = std::max(noise, camera.sigma_px);
      const double cap = 9 * noise * noise;
      double cost = 0;
      const auto errors = bundle::errors_of(growth.bundle);
      for (const auto& error : errors) cost += error ? std::min(cap, error->squaredNorm()) : cap;
      cost += cap * static_cast<double>(required - std::min(required, errors.size()));
      if (cost < best) best = cost, growth_ = std::move(growth);
    } catch (const Error&) {
      continue;  // another guess may do
    }
  }
  if (!std::isfinite(best))
    throw Error(
        "{}",
        "the cameras' views of people do not make one geometry: let one person walk through the whole volume, near and far, in "
        "another place than a line; check the lenses that the rig gives");
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
      const auto at = pixel(row, c, 0);
      if (!at) continue;
      const auto before = pixel(row, c, -2), after = pixel(row, c, 2);
      const Vector<2> velocity =
          before && after ? Vector<2>((*after - *before) * people_[c].rate_hz / 4) : Vector<2>(Vector<2>::Zero());
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
  const std::vector<PointRow> all = some_of(rows_, kMaxPoints);
  bool first = true;
  for (bundle::BundleCamera& camera : bundle_.cameras) {
    const auto c = static_cast<std::size_t>(&camera - bundle_.cameras.data());
    camera.refine_pose = !first;
    if (!rig_camera(c).lens) {
      camera.freedom = {cameras() > 2 ? kFocalPrior : kFocalOfTwo, 0, 0, {kDistortionPrior}};
      camera.known = wand::starting_lens(rig_camera(c), kLikelyFocal);
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
  fill(bundle_);
  fitted_ = bundle::adjust(bundle_, how);
  if (fitted_.inliers < kMinShared * static_cast<int>(cameras()) / 2)
    throw Error("only {} views of people's points fit together: let one person walk through the whole volume, and turn",
                fitted_.inliers);
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
      moved = std::max(moved, std::abs(bundle_.cameras[c].offset_s) * people_[c].rate_hz);
      offsets_[c] += std::exchange(bundle_.cameras[c].offset_s, 0);
    }
    if (moved < kOffsetFound || round == kOffsetRounds) return fitted;
  }
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
  const std::vector<double> offsets = offsets_;
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
  offsets_ = offsets;
}

void PeopleCalibration::put_into_world() {
  std::map<std::pair<int, double>, Body3> bodies;
  const std::size_t points = in_.cameras.front().sequence.set.points.size();
  for (std::size_t i = 0; i < bundle_.observations.size(); ++i) {
    const bundle::BundleObservation& detected = bundle_.observations[i];
    const PointRow& row = rows_[row_of_body_[static_cast<std::size_t>(detected.body)]];
    Body3& body = bodies[{row.person, row.time_s}];
    if (body.points.empty()) body = {row.person, row.time_s, std::vector<std::optional<Vector<3>>>(points)};
    if (fitted_.inlier[i]) body.points[row.point] = bundle::marker_position(bundle_, detected);
  }
  std::vector<Body3> in_order;
  for (auto& [key, body] : bodies) in_order.push_back(std::move(body));
  const auto world = world_of(in_order, in_.cameras.front().sequence.set);
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
    result_.notes.push_back(fmt::format(
        "how large all is is not known: the person was taken to be {:.2f} m tall; give --height, or --distance of two cameras",
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
    const double sigma = fitted_.deviations.empty() ? 0 : fitted_.deviations[c].centre.norm();
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
    camera.offset_s = offsets_[c] + bundle_.cameras[c].offset_s;
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

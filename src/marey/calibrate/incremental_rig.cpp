#include "marey/calibrate/incremental_rig.h"

#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>

#include "marey/calibrate/resection.h"
#include "marey/calibrate/two_views.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"

namespace marey::calibrate {
namespace {

constexpr std::size_t kMinShared = 12;   // instants that two cameras have to share to begin
constexpr std::size_t kMaxPairs = 12;    // inspected before one is chosen
constexpr double kGoodParallax = 0.15;   // rad, from which on more does not count
constexpr double kMinParallax = 0.01;    // rad
constexpr double kProportionOff = 0.05;  // by which the middle marker's share of the length may differ from the wand's

class IncrementalRig {
 public:
  IncrementalRig(const std::vector<StartingCamera>& cameras, const MarkerLine& line, const MarkTable& table, std::uint64_t seed,
                 const GrowthSubject& subject)
      : at_(cameras, line, table), markers_(line.markers()), seed_(seed), subject_(subject) {
    for (const StartingCamera& camera : cameras) known_.push_back(camera.lens);
  }

  Growth run() {
    begin();
    while (standing() < at_.cameras()) add_next();
    Growth growth;
    growth.fit = adjust_all(growth.bundle, 3);
    return growth;
  }

 private:
  struct Start {
    std::size_t a = 0, b = 0;
    std::vector<std::size_t> instants;
    TwoViews views = {};
    double score = 0;
  };

  std::size_t standing() const {
    return static_cast<std::size_t>(
        std::count_if(at_.poses.begin(), at_.poses.end(), [](const auto& pose) { return pose.has_value(); }));
  }

  std::optional<Start> choose();
  bool relate_pair(Start& pair);
  void begin();
  double metres_per_baseline(const Start& start);
  void require_proportions(const std::vector<double>& fractions) const;
  void add_next();
  bool set_camera(std::size_t c);
  bundle::BundleResult adjust_all(bundle::Bundle& bundle, int rounds);
  std::vector<int> fill(bundle::Bundle& bundle) const;

  void blame(std::string cause) {
    if (cause_.empty()) cause_ = std::move(cause);
  }

  LinePlacement at_;
  std::vector<geometry::Lens> known_;  // as they were given or guessed
  std::size_t markers_;
  std::uint64_t seed_;
  GrowthSubject subject_;
  std::string cause_;  // why the first of the pairs that failed did
};

std::optional<IncrementalRig::Start> IncrementalRig::choose() {
  std::vector<Start> pairs;
  for (std::size_t a = 0; a < at_.cameras(); ++a) {
    for (std::size_t b = a + 1; b < at_.cameras(); ++b) {
      Start pair{a, b, {}};
      for (std::size_t i = 0; i < at_.instants(); ++i) {
        if (at_.observes(i, a) && at_.observes(i, b)) pair.instants.push_back(i);
      }
      if (pair.instants.size() >= kMinShared) pairs.push_back(std::move(pair));
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Start& x, const Start& y) { return x.instants.size() > y.instants.size(); });
  if (pairs.size() > kMaxPairs) pairs.resize(kMaxPairs);
  std::optional<Start> best;
  for (Start& pair : pairs) {
    if (relate_pair(pair) && (!best || pair.score > best->score)) best = std::move(pair);
  }
  return best;
}

bool IncrementalRig::relate_pair(Start& pair) {
  std::vector<MarkPair> sights;
  for (const std::size_t i : pair.instants) sights.push_back({at_.bearings(i, pair.a), at_.bearings(i, pair.b)});
  const auto views = relate(sights, {markers_, at_.line().reversible(), at_.sigma(pair.a), at_.sigma(pair.b), seed_});
  const std::string &a = at_.camera(pair.a).name, &b = at_.camera(pair.b).name;
  if (!views || views->fraction < 0.5) {
    blame(
        fmt::format("what cameras \"{}\" and \"{}\" see at the same time does not fit together{}: are their lenses right, and were "
                    "they started together?",
                    a, b, views ? fmt::format(" (only {:.0f} % of {} views do)", 100 * views->fraction, sights.size()) : ""));
    return false;
  }
  if (views->one_position || (!views->plane && views->parallax < kMinParallax)) {
    blame(
        fmt::format("cameras \"{}\" and \"{}\" stand in one place (or are the same recording): they see everything under the same "
                    "directions, and no depth follows; move them apart",
                    a, b));
    return false;
  }
  if (views->plane) {
    blame(fmt::format("cameras \"{}\" and \"{}\" saw {} in a plane: {}", a, b, subject_.name, subject_.everywhere));
    return false;
  }
  pair.views = *views;
  pair.score = views->fraction * static_cast<double>(pair.instants.size()) * std::min(1.0, views->parallax / kGoodParallax);
  return true;
}

void IncrementalRig::begin() {
  const auto start = choose();
  if (!start)
    throw Error("{}", !cause_.empty()
                          ? cause_
                          : fmt::format("no two cameras see {} together often enough to begin: {}", subject_.name, subject_.more));
  at_.poses[start->a] = Rigid3{};
  at_.poses[start->b] = start->views.b_from_a;
  if (markers_ > 1) at_.poses[start->b]->translation *= metres_per_baseline(*start);
  for (std::size_t k = 0; k < start->instants.size(); ++k) {
    if (start->views.inlier[k]) at_.location(start->instants[k]);
  }
  bundle::Bundle bundle;
  adjust_all(bundle, 2);
}

double IncrementalRig::metres_per_baseline(const Start& start) {
  std::vector<double> lengths, fractions;
  for (std::size_t k = 0; k < start.instants.size(); ++k) {
    const std::size_t i = start.instants[k];
    const auto locations = start.views.inlier[k] ? at_.markers(i) : std::nullopt;
    if (!locations) continue;
    lengths.push_back(((*locations)[markers_ - 1] - (*locations)[0]).norm());
    if (markers_ == 3) fractions.push_back(((*locations)[1] - (*locations)[0]).norm() / lengths.back());
  }
  if (lengths.size() < kMinShared / 2) {
    throw Error("too few views of {} fit together: {}, where the cameras see it", subject_.name, subject_.more);
  }
  require_proportions(fractions);
  return at_.line().length() / geometry::median(lengths);
}

void IncrementalRig::require_proportions(const std::vector<double>& fractions) const {
  if (fractions.empty() || at_.line().reversible()) return;
  const double detected = geometry::median(std::vector(fractions)), stated = at_.line().distances[1] / at_.line().distances[2];
  if (std::abs(detected - stated) <= kProportionOff) return;
  throw Error(
      "the wand's middle marker lies at {:.0f} % of its length by what the cameras see, and at {:.0f} % by --wand: give the "
      "markers' distances as they are on this wand",
      100 * detected, 100 * stated);
}

/// The camera not yet standing that sees most of what is placed, set by it.
void IncrementalRig::add_next() {
  std::vector<std::pair<std::size_t, std::size_t>> candidates;  // how many, camera
  for (std::size_t c = 0; c < at_.cameras(); ++c) {
    if (at_.poses[c]) continue;
    std::size_t count = 0;
    for (std::size_t i = 0; i < at_.instants(); ++i) count += at_.bodies[i] && at_.observes(i, c) ? 1 : 0;
    candidates.emplace_back(count, c);
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [count, c] : candidates) {
    if (!set_camera(c)) continue;
    at_.position_all();
    bundle::Bundle bundle;
    adjust_all(bundle, 1);
    return;
  }
  const auto& [count, c] = candidates.front();
  throw Error(
      "camera \"{}\" cannot be set beside the others: {} of the places of {} that the others fix are seen by it{}; {}, and check "
      "its lens and that it was started with the others",
      at_.camera(c).name, count, subject_.name, count < kMinShared ? "" : ", and they do not fit together", subject_.shared);
}

bool IncrementalRig::set_camera(std::size_t c) {
  std::vector<MarkObservation> seen;
  std::vector<std::size_t> instants;
  for (std::size_t i = 0; i < at_.instants(); ++i) {
    if (!at_.bodies[i] || !at_.observes(i, c)) continue;
    MarkObservation one{{}, at_.bearings(i, c)};
    for (std::size_t m = 0; m < markers_; ++m) one.world[m] = at_.marker_at(*at_.bodies[i], m);
    seen.push_back(one);
    instants.push_back(i);
  }
  const auto found = resect(seen, {markers_, at_.line().reversible(), at_.sigma(c), seed_});
  if (!found || 2 * found->inliers < seen.size() || found->inliers < kMinShared / 2) return false;
  at_.poses[c] = found->camera_from_world;
  for (std::size_t k = 0; k < instants.size(); ++k) at_.rotated[instants[k]][c] = found->rotated[k];
  return true;
}

/// What stands and is placed, as a bundle; gives each camera's place in it, -1 for none.
std::vector<int> IncrementalRig::fill(bundle::Bundle& bundle) const {
  std::vector<int> place_in_bundle(at_.cameras(), -1);
  const bool lens_shows = markers_ > 1 || standing() > 2;
  bundle.wand = at_.line().distances;
  for (std::size_t c = 0; c < at_.cameras(); ++c) {
    if (!at_.poses[c]) continue;
    place_in_bundle[c] = static_cast<int>(bundle.cameras.size());
    bundle::BundleCamera camera{at_.camera(c).lens, *at_.poses[c], 0, lens_shows ? at_.camera(c).freedom : bundle::LensFreedom{}};
    camera.known = known_[c];
    camera.refine_pose = !bundle.cameras.empty();
    bundle.cameras.push_back(camera);
  }
  for (std::size_t i = 0; i < at_.instants(); ++i) {
    bundle.bodies.push_back(at_.bodies[i].value_or(bundle::Body(Vector<3>(Vector<3>::Zero()))));
    for (std::size_t c = 0; at_.bodies[i] && c < at_.cameras(); ++c) {
      for (std::size_t m = 0; at_.poses[c] && at_.observes(i, c) && m < markers_; ++m) {
        bundle.observations.push_back({place_in_bundle[c], static_cast<int>(i), static_cast<int>(m), at_.pixel(i, c, m)});
      }
    }
  }
  return place_in_bundle;
}

/// Adjusts the static cameras and what is placed, and takes both over.
bundle::BundleResult IncrementalRig::adjust_all(bundle::Bundle& bundle, int rounds) {
  const std::vector<int> place_in_bundle = fill(bundle);
  bundle::BundleOptions options;
  options.noise_px = 0;
  for (std::size_t c = 0; c < at_.cameras(); ++c) options.noise_px = std::max(options.noise_px, at_.camera(c).sigma_px / 2);
  options.rounds = rounds;
  options.tolerance = 1e-6;
  options.deviations = false;
  const bundle::BundleResult result = bundle::adjust(bundle, options);
  for (std::size_t c = 0; c < at_.cameras(); ++c) {
    if (place_in_bundle[c] < 0) continue;
    const bundle::BundleCamera& camera = bundle.cameras[static_cast<std::size_t>(place_in_bundle[c])];
    at_.poses[c] = camera.camera_from_world;
    at_.set_lens(c, camera.lens);
  }
  for (std::size_t i = 0; i < at_.instants(); ++i) {
    if (at_.bodies[i]) at_.bodies[i] = bundle.bodies[i];
  }
  return result;
}

}  // namespace

Growth grow_rig(const std::vector<StartingCamera>& cameras, const MarkerLine& line, const MarkTable& table, std::uint64_t seed,
                const GrowthSubject& subject) {
  return IncrementalRig(cameras, line, table, seed, subject).run();
}

std::vector<std::vector<int>> shared_views(const MarkTable& table, std::size_t cameras) {
  std::vector<std::vector<int>> shared(cameras, std::vector<int>(cameras, 0));
  for (const auto& row : table) {
    for (std::size_t a = 0; a < cameras; ++a) {
      for (std::size_t b = 0; b < cameras; ++b) shared[a][b] += row[a] && row[b] ? 1 : 0;
    }
  }
  return shared;
}

void require_connected(const std::vector<std::string>& names, const std::vector<std::vector<int>>& shared, int minimum) {
  std::vector<char> reached(names.size(), 0);
  std::vector<std::size_t> open = {0};
  reached[0] = 1;
  while (!open.empty()) {
    const std::size_t a = open.back();
    open.pop_back();
    for (std::size_t b = 0; b < names.size(); ++b) {
      if (reached[b] || shared[a][b] < minimum) continue;
      reached[b] = 1;
      open.push_back(b);
    }
  }
  std::vector<std::string> here, there;
  for (std::size_t c = 0; c < names.size(); ++c) (reached[c] ? here : there).push_back(names[c]);
  if (there.empty()) return;
  throw Error(
      "cameras {} share no view with {} (fewer than {} instants at which both see the wand): wave it where cameras of both "
      "groups see it, or calibrate the groups apart",
      fmt::join(here, ", "), fmt::join(there, ", "), minimum);
}

}  // namespace marey::calibrate

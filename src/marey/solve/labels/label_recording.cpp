#include "marey/solve/labels/label_recording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <numeric>
#include <optional>

#include "marey/assign/gated_assignment.h"
#include "marey/assign/no_index.h"
#include "marey/core/error.h"
#include "marey/geometry/layout.h"
#include "marey/geometry/median.h"
#include "marey/solve/labels/check_names.h"
#include "marey/solve/labels/labelled_result.h"
#include "marey/solve/labels/learn_markers.h"
#include "marey/solve/labels/named_chains.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr double kInitialiseS = 0.15;    // s: a chain that a name is searched for from nothing is at least this long
constexpr double kMinInitialised = 0.4;  // of the set's markers, below which nothing is reported
constexpr std::size_t kMaxPointsToInitialise = 160;
constexpr double kMisfit = 2, kMaxWider = 4;  // times as far off as distances of the subject that taught are

std::pair<double, double> extent_of(std::vector<double> heights) {
  std::sort(heights.begin(), heights.end());
  return {heights[heights.size() / 20], heights[heights.size() - 1 - heights.size() / 20]};
}

/// The whole processing of one recording.
class Labelling {
 public:
  Labelling(const Recording& recording, const LearnedMarkers& learned, const LabelOptions& options, const Hooks& hooks)
      : recording_(recording), learned_(learned), options_(options), distances_(options.distances), hooks_(hooks), chains_([&] {
          auto tracklets = tracklets_of(recording, options.tracklets);
          const auto chain_of = chains_of(tracklets, recording.header.rate_hz, options.tracklets);
          return NamedChains(std::move(tracklets), chain_of, recording.instants().size(), learned.size());
        }()) {}

  Labelled run() {
    name_person();
    Labelled labelled = labelled_result(recording_, learned_, chains_, *model_, review_items_, scale_);
    for (const int other : undecided_) labelled.undecided.push_back(other == kNoIndex ? 0 : 1);
    const Misfit misfit_now = misfit();
    labelled.misfit = misfit_now.ratio;
    labelled.misfit_m = misfit_now.off_m;
    if (person_) labelled.found_again = found_again_;
    return labelled;
  }

 private:
  void name_all() {
    initialise();
    for (int round = 0; round < options_.rounds; ++round) {
      hooks_.advance({.step = "naming", .done = round + 1, .total = options_.rounds + 1});
      chains_.gather();
      if (round > 0) {
        cut_untrusted();  // before they spoil the learned distances
        chains_.gather();
      }
      if (round > 0 || !learned_.moves || person_)
        refine();  // a subject who stood still gave no rigid distances: the first names do
      distribute();
    }
    chains_.gather();
    refine();
  }

  bool is_scaled() const { return learned_.scaled || person_; }
  DistanceModel taught(double scale) const {
    return person_ ? DistanceModel(learned_, scale, distances_, *person_) : DistanceModel(learned_, scale, distances_);
  }
  void name_person();
  void decide(std::vector<int> undecided);
  double found() const;
  bool scale_to_person();
  void scale_segments();
  std::vector<int> search_again();
  LabelHypothesis answer_at(std::size_t instant, double scale, std::vector<int>& chains, std::size_t& crowd) const;
  void forget();

  /// Of those that have names now, by what was taught.
  Misfit misfit() const {
    if (person_) return misfit_of(chains_.named_distances(), taught(scale_));
    return misfit_of(chains_.named_distances(), DistanceModel(learned_, scale_, options_.distances));
  }
  std::vector<int> check();
  void drop(const std::vector<int>& undecided);
  void initialise();
  [[noreturn]] void fail_to_initialise(std::ptrdiff_t booted, std::size_t crowd) const;
  void refine();
  void distribute();
  void cut_untrusted();
  void assess();
  std::vector<std::size_t> initialise_instants(int count) const;
  std::vector<double> scales(std::size_t instant) const;
  LabelHypothesis initialise_again(const InitialiseScene& scene, const LabelHypothesis& first, DistanceModel model,
                                   const Matrix<3>& turn) const;
  std::optional<Matrix<3>> turn_to_learned(const InitialiseScene& scene, const LabelHypothesis& answer) const;
  void settle(const std::vector<std::vector<int>>& votes);
  double margin(int chain, int name, const std::vector<NamedChains::Fits>& fits, int& next) const;

  const Recording& recording_;
  const LearnedMarkers& learned_;
  const LabelOptions& options_;
  DistanceOptions distances_;
  const Hooks& hooks_;
  NamedChains chains_;
  std::unique_ptr<DistanceModel> model_;
  double scale_ = 1;
  std::optional<AnotherPerson> person_;
  bool scale_known_ = false;
  double found_again_ = 0;                  // of the names, in other searches
  std::vector<int> undecided_;              // by name: which other it could as well be
  std::vector<int> search_again_;           // by name: which other those give
  std::map<int, ReviewItem> review_items_;  // by chain without a name
  std::vector<std::vector<int>> bearers_;   // by name, of the last round
};

void Labelling::forget() {
  review_items_.clear();
  for (int chain = 0; chain < std::ssize(chains_.chains()); ++chain) chains_.set_name(chain, kNoIndex);
}

/// Names of the person who taught the set; or of another, for which it is then scaled; or, where that does not hold, as well as may
/// be.
void Labelling::name_person() {
  const bool scalable = options_.scale_to_person && learned_.moves && !learned_.scaled;
  std::optional<Error> failure;
  double wider = 1;
  try {
    name_all();
    wider = std::clamp(misfit().ratio, 1.0, kMaxWider);
    const bool fits = !learned_.moves || wider <= kMisfit;
    if (fits) {
      decide(check());
      if (!scalable || wider <= 1 || found() >= options_.scaling.few_found) return;
    }
  } catch (const Error& error) {
    if (!scalable) throw;
    failure = error;
  }
  if (scalable && scale_to_person()) return decide(search_again_);
  person_.reset();
  scale_ = 1, scale_known_ = false;
  if (failure) throw *failure;
  if (wider > kMisfit) {  // what distances may be off is measured
    distances_.shift *= wider;
    distances_.fraction *= wider;
  }
  forget();
  name_all();
  decide(check());
}

void Labelling::decide(std::vector<int> undecided) {
  assess();
  drop(undecided);
  undecided_ = std::move(undecided);
}

/// The share of the set's names that are given.
double Labelling::found() const {
  std::vector<char> given(learned_.size(), 0);
  for (const auto& chain : chains_.chains()) {
    if (chain.name != kNoIndex) given[static_cast<std::size_t>(chain.name)] = 1;
  }
  return static_cast<double>(std::count(given.begin(), given.end(), 1)) / static_cast<double>(learned_.size());
}

/// Names from nothing, of another person than the one who taught the set: by its stature, then by its segments. False if they are
/// not found again.
bool Labelling::scale_to_person() {
  person_.emplace();
  try {
    for (int pass = 0; pass < options_.scaling.passes; ++pass) {
      forget();
      name_all();
      scale_segments();
    }
  } catch (const Error&) {
    return false;
  }
  search_again_ = search_again();
  const Misfit now = misfit();
  return found_again_ >= options_.scaling.min_found_again && now.ratio <= kMisfit;
}

/// What the names say of the sizes: of the person, then of each segment by the distances that the set knows as rigid.
void Labelling::scale_segments() {
  const std::vector<DistanceObserved> named = chains_.named_distances();
  std::vector<double> all;
  std::vector<std::vector<double>> of_name(learned_.size());
  for (std::size_t a = 1; a < learned_.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      const LearnedMarkers::Distance& distance = learned_.between(a, b);
      const DistanceObserved& detected = named[LearnedMarkers::index_of(a, b)];
      if (detected.count < options_.scaling.instants || distance.mean < options_.scaling.distance) continue;
      all.push_back(detected.mean / distance.mean);
      if (distance.deviation > options_.scaling.rigid || detected.variance > 4 * options_.scaling.rigid * options_.scaling.rigid)
        continue;
      of_name[a].push_back(all.back());
      of_name[b].push_back(all.back());
    }
  }
  if (all.empty()) return;
  scale_ = geometry::median(all);
  scale_known_ = true;
  person_->scale_of.clear();
  for (std::vector<double>& its : of_name) {
    const auto count = static_cast<double>(its.size());
    const double own = its.empty() ? 1 : geometry::median(its) / scale_;
    person_->scale_of.push_back(std::clamp((count * own + options_.scaling.prior) / (count + options_.scaling.prior),
                                           options_.scaling.min_segment, options_.scaling.max_segment));
  }
}

/// Searches from nothing at other instants, by what was taught and scaled alone. Of names that they barely agree on, and of those
/// that none of them finds, which other they give most: by name, itself if there is no other.
std::vector<int> Labelling::search_again() {
  std::vector<std::vector<int>> given(learned_.size(), std::vector<int>(learned_.size(), 0));  // by name now, and there
  double same = 0, all = 0;
  for (const std::size_t instant : initialise_instants(options_.initialises + 1)) {
    std::vector<int> chains;
    std::size_t crowd = 0;
    const LabelHypothesis answer = answer_at(instant, scale_, chains, crowd);
    for (std::size_t name = 0; name < answer.point_of.size(); ++name) {
      if (answer.point_of[name] == kNoIndex) continue;
      const int now = chains_.chains()[static_cast<std::size_t>(chains[static_cast<std::size_t>(answer.point_of[name])])].name;
      ++all;
      same += now == static_cast<int>(name);
      if (now != kNoIndex) ++given[static_cast<std::size_t>(now)][name];
    }
  }
  found_again_ = all > 0 ? same / all : 0;
  std::vector<int> undecided(learned_.size(), kNoIndex);
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    const int count = std::accumulate(given[name].begin(), given[name].end(), 0), own = given[name][name];
    if (own > 0 && own >= options_.scaling.min_found_again_of_name * count) continue;
    given[name][name] = 0;
    const auto most = std::max_element(given[name].begin(), given[name].end());
    undecided[name] = static_cast<int>(*most > 0 ? most - given[name].begin() : static_cast<std::ptrdiff_t>(name));
  }
  return undecided;
}

/// Instants at which long chains are many, spread over the recording.
std::vector<std::size_t> Labelling::initialise_instants(int count) const {
  const auto merit = [&](std::size_t instant) {
    double sum = 0;
    for (const auto& point : chains_.at(instant))
      sum += std::min(chains_.chains()[static_cast<std::size_t>(point.chain)].points, 200);
    return sum;
  };
  std::vector<std::size_t> best;
  const auto parts = static_cast<std::size_t>(count);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * chains_.instants() / parts, end = (part + 1) * chains_.instants() / parts;
    std::size_t its = begin;
    double maximum = -1;
    const std::size_t step = std::max<std::size_t>(1, (end - begin) / 50);
    for (std::size_t i = begin; i < end; i += step) {
      if (const double value = merit(i); value > maximum) maximum = value, its = i;
    }
    if (begin < end) best.push_back(its);
  }
  return best;
}

/// Sizes of the subject that come into question: by how high it reaches, against the posture it was learned in.
std::vector<double> Labelling::scales(std::size_t instant) const {
  if (!is_scaled()) return {1};
  std::vector<double> here, there;
  for (const auto& point : chains_.at(instant)) here.push_back(point.location.z());
  for (const Vector<3>& location : learned_.locations) there.push_back(location.z());
  if (here.size() < 4) return {1};
  const auto [low, high] = extent_of(here);
  const auto [learned_low, learned_high] = extent_of(there);
  const double ratio = std::clamp((high - low) / std::max(learned_high - learned_low, 0.1), 0.5, 2.0);
  return {ratio, 0.95 * ratio, 1.05 * ratio, 0.9 * ratio, 1.1 * ratio};
}

/// If the learned model stems from others, their posture distinguishes left and right: how that lies to the subject as it was named
/// first. (One's own posture, standing still, is less informative than one's own distances.)
std::optional<Matrix<3>> Labelling::turn_to_learned(const InitialiseScene& scene, const LabelHypothesis& answer) const {
  if (!is_scaled()) return std::nullopt;
  std::vector<Vector<3>> from, to;
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    if (answer.point_of[name] == kNoIndex || learned_.locations[name].isZero(0)) continue;
    from.push_back(scene.locations[static_cast<std::size_t>(answer.point_of[name])]);
    to.push_back(learned_.locations[name]);
  }
  if (from.size() < 4) return std::nullopt;
  return geometry::rigid_fit(from, to).rotation;
}

/// Once more, with what the first answer says of directions and, where that was not learned, of what is rigid.
LabelHypothesis Labelling::initialise_again(const InitialiseScene& scene, const LabelHypothesis& first, DistanceModel model,
                                            const Matrix<3>& turn) const {
  for (std::size_t a = 1; a < learned_.size() && !learned_.moves; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (first.point_of[a] == kNoIndex || first.point_of[b] == kNoIndex) continue;
      const auto& detected =
          scene.between(static_cast<std::size_t>(first.point_of[a]), static_cast<std::size_t>(first.point_of[b]));
      model.set_rank(a, b, std::sqrt(detected.variance) + 0.002);
    }
  }
  model.rank();
  return initialise_labels(scene, learned_, model, options_.initialise, turn);
}

void Labelling::fail_to_initialise(std::ptrdiff_t booted, std::size_t crowd) const {
  const std::vector<std::string> near = too_near_for_markers(learned_);
  if (!near.empty())
    throw Error(
        "{}: of the {} points of the set {} can be reported by their distances: {} of them, as {} and {}, lie within 10 mm of "
        "another, "
        "as points do that a program computed (joints' centres); learn the set again and name the markers alone: "
        "\"marey label learn --markers ...\"",
        recording_.header.name, learned_.size(), booted, near.size(), near.front(), near.back());
  if (crowd > 0)
    throw Error(
        "{}: {} points stand in a frame, and names are searched for among {} at most; where a program computed most of them "
        "(joints' centres), leave those out first",
        recording_.header.name, crowd, kMaxPointsToInitialise);
  throw Error("{}: of the {} markers of the set {} can be reported by their distances; is it this subject's, and in metres?",
              recording_.header.name, learned_.size(), booted);
}

/// Names from nothing at one instant; none if too few points, or too many, are there.
LabelHypothesis Labelling::answer_at(std::size_t instant, double scale, std::vector<int>& chains, std::size_t& crowd) const {
  const auto shortest = static_cast<std::int32_t>(std::max(4.0, kInitialiseS * recording_.header.rate_hz));
  InitialiseScene scene;
  scene.detected = chains_.distances_at(instant, shortest, chains, scene.locations);
  if (chains.size() > kMaxPointsToInitialise) crowd = std::max(crowd, chains.size());
  if (chains.size() < 4 || chains.size() > kMaxPointsToInitialise) return {};
  const DistanceModel model = taught(scale);
  LabelHypothesis answer = initialise_labels(scene, learned_, model, options_.initialise);
  if (const auto turn = turn_to_learned(scene, answer)) return initialise_again(scene, answer, model, *turn);
  return answer;
}

void Labelling::initialise() {
  double best_score = 0;
  std::vector<int> best_chains;
  LabelHypothesis best;
  std::size_t crowd = 0;  // points of the fullest instant that was skipped for them
  for (const std::size_t instant : initialise_instants(options_.initialises)) {
    hooks_.advance({.step = "naming", .done = 0, .total = options_.rounds + 1});
    for (const double scale : (best_score > 0 || scale_known_) && is_scaled() ? std::vector{scale_} : scales(instant)) {
      std::vector<int> chains;
      LabelHypothesis answer = answer_at(instant, scale, chains, crowd);
      if (answer.score <= best_score) continue;
      best_score = answer.score, best = std::move(answer), best_chains = std::move(chains), scale_ = scale;
    }
  }
  const auto booted = std::count_if(best.point_of.begin(), best.point_of.end(), [](int point) { return point != kNoIndex; });
  if (static_cast<double>(booted) < kMinInitialised * static_cast<double>(learned_.size())) fail_to_initialise(booted, crowd);
  model_ = std::make_unique<DistanceModel>(taught(scale_));
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    if (best.point_of[name] != kNoIndex)
      chains_.set_name(best_chains[static_cast<std::size_t>(best.point_of[name])], static_cast<int>(name));
  }
}

void Labelling::refine() {
  const std::vector<DistanceObserved> detected = chains_.named_distances();
  for (std::size_t a = 1; a < learned_.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) model_->adopt(a, b, detected[LearnedMarkers::index_of(a, b)]);
  }
  model_->rank();
}

void Labelling::distribute() {
  const auto& all = chains_.chains();
  std::vector<NamedChains::Fits> fits;
  for (int chain = 0; chain < std::ssize(all); ++chain) fits.push_back(chains_.fits_of_chain(chain, *model_, options_.neighbours));
  std::vector<std::vector<int>> votes(all.size(), std::vector<int>(learned_.size(), 0));
  assign::GatedAssigner assigner;
  std::vector<assign::GatedPair> pairs;
  const std::size_t step = std::max<std::size_t>(1, chains_.instants() / 1000);
  for (std::size_t instant = 0; instant < chains_.instants(); instant += step) {
    const auto points = chains_.at(instant);
    pairs.clear();
    for (int p = 0; p < std::ssize(points); ++p) {
      const auto& its = fits[static_cast<std::size_t>(points[static_cast<std::size_t>(p)].chain)];
      for (int name = 0; name < std::ssize(its); ++name) {
        if (its[static_cast<std::size_t>(name)] > options_.min_fit / 2)
          pairs.push_back({p, name, its[static_cast<std::size_t>(name)]});
      }
    }
    const std::span<const int> names = assigner.assign(static_cast<int>(points.size()), static_cast<int>(learned_.size()), pairs);
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (names[p] != kNoIndex) ++votes[static_cast<std::size_t>(points[p].chain)][static_cast<std::size_t>(names[p])];
    }
  }
  if (step > 1) {  // chains between the instants that vote
    for (std::size_t chain = 0; chain < all.size(); ++chain) {
      const auto best = std::max_element(fits[chain].begin(), fits[chain].end());
      const bool requested = std::any_of(votes[chain].begin(), votes[chain].end(), [](int count) { return count > 0; });
      if (!requested && all[chain].points < static_cast<std::int32_t>(step) && *best > options_.min_fit)
        votes[chain][static_cast<std::size_t>(best - fits[chain].begin())] = 1;
    }
  }
  settle(votes);
}

/// Those with most votes first; one there at the same time as another that has the name takes its next.
void Labelling::settle(const std::vector<std::vector<int>>& votes) {
  struct Claim {
    int count, chain, name;
  };
  std::vector<Claim> claims;
  for (int chain = 0; chain < std::ssize(votes); ++chain) {
    chains_.set_name(chain, kNoIndex);
    for (int name = 0; name < std::ssize(votes[static_cast<std::size_t>(chain)]); ++name) {
      const int count = votes[static_cast<std::size_t>(chain)][static_cast<std::size_t>(name)];
      if (count > 0) claims.push_back({count, chain, name});
    }
  }
  std::sort(claims.begin(), claims.end(),
            [](const Claim& a, const Claim& b) { return std::tie(b.count, a.chain, a.name) < std::tie(a.count, b.chain, b.name); });
  bearers_.assign(learned_.size(), {});
  for (const Claim& claim : claims) {
    if (chains_.chains()[static_cast<std::size_t>(claim.chain)].name != kNoIndex) continue;
    auto& its = bearers_[static_cast<std::size_t>(claim.name)];
    if (std::any_of(its.begin(), its.end(), [&](int other) { return chains_.overlap(claim.chain, other); })) continue;
    chains_.set_name(claim.chain, claim.name);
    its.push_back(claim.chain);
  }
}

/// Tracklets that fit another name much better than their chain's.
void Labelling::cut_untrusted() {
  for (int chain = 0, count = static_cast<int>(chains_.chains().size()); chain < count; ++chain) {
    const auto its = chains_.chains()[static_cast<std::size_t>(chain)];
    if (its.tracklets.size() < 2 || its.name == kNoIndex) continue;
    for (const int tracklet : its.tracklets) {
      const auto fits = chains_.fits_of_tracklet(tracklet, *model_, options_.neighbours);
      const double best = *std::max_element(fits.begin(), fits.end());
      if (best > fits[static_cast<std::size_t>(its.name)] + options_.min_margin ||
          fits[static_cast<std::size_t>(its.name)] < options_.min_fit)
        chains_.cut_off(tracklet);
    }
  }
}

/// By how much a chain's name is better than any other it could have: one that is free in its time, or one that it could exchange.
double Labelling::margin(int chain, int name, const std::vector<NamedChains::Fits>& fits, int& next) const {
  const auto& own = fits[static_cast<std::size_t>(chain)];
  double minimum = own[static_cast<std::size_t>(name)];
  next = kNoIndex;
  for (int other = 0; other < std::ssize(own); ++other) {
    if (other == name) continue;
    double loss = own[static_cast<std::size_t>(name)] - own[static_cast<std::size_t>(other)];
    for (const int holder : bearers_[static_cast<std::size_t>(other)]) {
      if (holder == chain || !chains_.overlap(chain, holder)) continue;
      const auto& its = fits[static_cast<std::size_t>(holder)];
      // The holder would go without a name, or take this one's.
      loss += its[static_cast<std::size_t>(other)] - std::max(its[static_cast<std::size_t>(name)], 0.0);
    }
    if (loss < minimum) minimum = loss, next = other;
  }
  return minimum;
}

/// Holds the names against what was taught alone, and puts right what is better otherwise. Returns which of them could as well be
/// another, by name.
std::vector<int> Labelling::check() {
  const DistanceModel as_taught = taught(scale_);
  const CheckedNames checked =
      check_names(chains_, learned_, as_taught, options_.initialise, options_.neighbours, options_.min_margin);
  std::vector<int> name_of(learned_.size(), kNoIndex);
  bool changed = false;
  for (std::size_t name = 0; name < learned_.size(); ++name) {
    if (checked.holder_of[name] == kNoIndex) continue;
    name_of[static_cast<std::size_t>(checked.holder_of[name])] = static_cast<int>(name);
    changed = changed || checked.holder_of[name] != static_cast<int>(name);
  }
  if (!changed) return checked.undecided;
  bearers_.assign(learned_.size(), {});
  for (int chain = 0; chain < std::ssize(chains_.chains()); ++chain) {
    const int was = chains_.chains()[static_cast<std::size_t>(chain)].name;
    if (was == kNoIndex) continue;
    const int name = name_of[static_cast<std::size_t>(was)];
    chains_.set_name(chain, name);
    if (name != kNoIndex) bearers_[static_cast<std::size_t>(name)].push_back(chain);
  }
  model_ = std::make_unique<DistanceModel>(taught(scale_));
  chains_.gather();
  refine();
  return checked.undecided;
}

void Labelling::drop(const std::vector<int>& undecided) {
  for (int chain = 0; chain < std::ssize(chains_.chains()); ++chain) {
    const int name = chains_.chains()[static_cast<std::size_t>(chain)].name;
    if (name == kNoIndex || undecided[static_cast<std::size_t>(name)] == kNoIndex) continue;
    review_items_[chain] = {.best = name, .next = undecided[static_cast<std::size_t>(name)], .fit = options_.min_fit, .margin = 0};
    chains_.set_name(chain, kNoIndex);
  }
  chains_.gather();
}

void Labelling::assess() {
  std::vector<NamedChains::Fits> fits;
  for (int chain = 0; chain < std::ssize(chains_.chains()); ++chain)
    fits.push_back(chains_.fits_of_chain(chain, *model_, options_.neighbours));
  std::vector<int> dropped;
  for (int chain = 0; chain < std::ssize(chains_.chains()); ++chain) {
    const auto& its = fits[static_cast<std::size_t>(chain)];
    const int name = chains_.chains()[static_cast<std::size_t>(chain)].name;
    ReviewItem review_item;
    if (name == kNoIndex) {
      const auto best = std::max_element(its.begin(), its.end());
      if (*best > 0) {
        review_item.best = static_cast<int>(best - its.begin());
        review_item.fit = *best;
        review_item.margin = margin(chain, review_item.best, fits, review_item.next);
      }
      review_items_[chain] = review_item;
      continue;
    }
    review_item.best = name;
    review_item.fit = its[static_cast<std::size_t>(name)];
    review_item.margin = margin(chain, name, fits, review_item.next);
    if (review_item.fit >= options_.min_fit && review_item.margin >= options_.min_margin) continue;
    review_items_[chain] = review_item;
    dropped.push_back(chain);
  }
  for (const int chain : dropped) chains_.set_name(chain, kNoIndex);
  chains_.gather();
}

}  // namespace

Labelled label_recording(const Recording& recording, const LearnedMarkers& learned, const LabelOptions& options,
                         const Hooks& hooks) {
  if (recording.header.frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: names are found for points in space, and these positions are {}", recording.header.name,
                to_string(recording.header.frame));
  if (recording.instants().empty()) throw Error("{}: holds no frame", recording.header.name);
  return Labelling(recording, learned, options, hooks).run();
}

}  // namespace marey::solve::labels

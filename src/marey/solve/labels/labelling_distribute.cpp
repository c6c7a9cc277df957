// How names are distributed among chains, and checked against the learned distances.
#include <algorithm>
#include <cmath>

#include "marey/assign/gated_assignment.h"
#include "marey/solve/labels/labelling.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

}  // namespace

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
    candidates_[chain] = {.best = name, .next = undecided[static_cast<std::size_t>(name)], .fit = options_.min_fit, .margin = 0};
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
    NameCandidates candidates;
    if (name == kNoIndex) {
      const auto best = std::max_element(its.begin(), its.end());
      if (*best > 0) {
        candidates.best = static_cast<int>(best - its.begin());
        candidates.fit = *best;
        candidates.margin = margin(chain, candidates.best, fits, candidates.next);
      }
      candidates_[chain] = candidates;
      continue;
    }
    candidates.best = name;
    candidates.fit = its[static_cast<std::size_t>(name)];
    candidates.margin = margin(chain, name, fits, candidates.next);
    if (candidates.fit >= options_.min_fit && candidates.margin >= options_.min_margin) continue;
    candidates_[chain] = candidates;
    dropped.push_back(chain);
  }
  for (const int chain : dropped) chains_.set_name(chain, kNoIndex);
  chains_.gather();
}

}  // namespace marey::solve::labels

#include "marey/solve/labels/label_recording.h"

#include <algorithm>
#include <numeric>
#include <optional>

#include "marey/core/error.h"
#include "marey/geometry/median.h"
#include "marey/solve/labels/labelling.h"

namespace marey::solve::labels {
namespace {

using assign::kNoIndex;

constexpr double kMisfit = 2, kMaxWider = 4;  // times as far off as distances of the subject that taught are

}  // namespace

void Labelling::forget() {
  candidates_.clear();
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

Labelled label_recording(const Recording& recording, const LearnedMarkers& learned, const LabelOptions& options,
                         const Hooks& hooks) {
  if (recording.header.frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: names are found for points in space, and these positions are {}", recording.header.name,
                to_string(recording.header.frame));
  if (recording.instants().empty()) throw Error("{}: holds no frame", recording.header.name);
  return Labelling(recording, learned, options, hooks).run();
}

}  // namespace marey::solve::labels

#include "marey/calibrate/people/people_pairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "marey/calibrate/two_views.h"
#include "marey/core/stop.h"

namespace marey::calibrate::people {
namespace {

constexpr std::size_t kMaxSharedPoints = 240;  // numerical, time against precision: of two views, that are related
constexpr std::size_t kMinSharedPoints = 40;   // unswept
constexpr int kDraws = 400;                    // numerical, time against precision: of RANSAC
constexpr double kFits = 0.5;                  // unswept: share of points that fit when it is one person at the right shift
constexpr double kSameTime = 2;                // unswept: frames by which shifts of a pair may differ from what other pairs say
constexpr std::size_t kMaxPeople = 6;  // numerical, time against precision: of a camera, the longest seen, that are compared
constexpr double kRelatedNoise = 0.5;  // unswept: times what the points state

struct PairEdge {
  std::size_t camera_a = 0, person_a = 0, camera_b = 0, person_b = 0;
  double shift_s = 0;  ///< added to b's times, beyond its offset
  double fraction = 0, points = 0;
  double support() const { return fraction * points; }
};

class PeopleMatcher {
 public:
  PeopleMatcher(const std::vector<CameraPeople>& cameras, double max_offset_s, std::uint64_t seed)
      : cameras_(cameras), max_offset_s_(max_offset_s), seed_(seed) {
    for (const CameraPeople& camera : cameras) grid_hz_ = std::max(grid_hz_, camera.rate_hz);
  }

  PeopleMatch run();

 private:
  struct Fit {
    double fraction = 0, points = 0;
  };

  bool moves(std::size_t a, std::size_t b) const {
    return max_offset_s_ > 0 && !(cameras_[a].offset_known && cameras_[b].offset_known);
  }
  Fit fit(const PairEdge& edge, double shift_s) const;
  std::optional<PairEdge> relate_people(PairEdge edge) const;
  std::vector<PairEdge> edges() const;
  bool may_be_one(const PeopleMatch& match, int a, int b) const;
  static void count_shared(PeopleMatch& match);

  const std::vector<CameraPeople>& cameras_;
  double max_offset_s_;
  std::uint64_t seed_;
  double grid_hz_ = 1;
};

/// Of the points that both show at the same time, how many one geometry explains.
PeopleMatcher::Fit PeopleMatcher::fit(const PairEdge& edge, double shift_s) const {
  const CameraPeople &a = cameras_[edge.camera_a], &b = cameras_[edge.camera_b];
  const ImagePerson &one = a.people[edge.person_a], &other = b.people[edge.person_b];
  std::vector<std::pair<Vector<2>, Vector<2>>> shared;
  for (std::size_t k = one.first; k < one.end(); ++k) {
    const double time = static_cast<double>(k) / a.rate_hz + a.offset_s;
    const double frame = (time - shift_s - b.offset_s) * b.rate_hz;
    for (std::size_t i = 0; i < one.frames[k - one.first].size(); ++i) {
      const auto here = one.at(static_cast<double>(k), i);
      const auto there = here ? other.at(frame, i) : std::nullopt;
      if (there) shared.emplace_back(*here, *there);
    }
  }
  if (shared.size() < kMinSharedPoints) return {};
  std::vector<MarkPair> pairs;
  const std::size_t count = std::min(kMaxSharedPoints, shared.size());
  constexpr double kGolden = 0.6180339887498949;
  for (std::size_t k = 0; k < count; ++k) {  // spread over time and over the points
    const double at = std::fmod(static_cast<double>(k + 1) * kGolden, 1.0);
    const auto& [here, there] = shared[static_cast<std::size_t>(at * static_cast<double>(shared.size()))];
    const auto at_a = a.lens.bearing(here), at_b = b.lens.bearing(there);
    if (!at_a || !at_b) continue;
    MarkPair pair;
    pair.a.fill(*at_a), pair.b.fill(*at_b);
    pairs.push_back(pair);
  }
  const auto sigma = [](const CameraPeople& camera, const ImagePerson& person) {
    return kRelatedNoise * person.sigma_px / geometry::focal_of(camera.lens.lens()).x();
  };
  TwoViewOptions how{.markers = 1, .reversible = false, .sigma_a = sigma(a, one), .sigma_b = sigma(b, other), .seed = seed_};
  how.max_draws = kDraws;
  const auto views = relate(pairs, how);
  return {views && !views->plane && !views->one_position ? views->fraction : 0, static_cast<double>(shared.size())};
}

/// The shift at which most points fit: the best peak, then climbed in steps down to half a frame.
std::optional<PairEdge> PeopleMatcher::relate_people(PairEdge edge) const {
  const int steps = moves(edge.camera_a, edge.camera_b) ? static_cast<int>(std::ceil(max_offset_s_ * grid_hz_)) : 0;
  std::vector<double> fractions(static_cast<std::size_t>(2 * steps + 1));
  std::vector<double> points(fractions.size());
  for (int k = -steps; k <= steps; ++k) {
    const Fit found = fit(edge, k / grid_hz_);
    fractions[static_cast<std::size_t>(k + steps)] = found.fraction, points[static_cast<std::size_t>(k + steps)] = found.points;
  }
  const auto smoothed = [&](std::ptrdiff_t k) {  // RANSAC's draws are of chance
    const auto at = [&](std::ptrdiff_t i) {
      return fractions[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 0, 2 * steps))];
    };
    return (at(k - 1) + 2 * at(k) + at(k + 1)) / 4;
  };
  std::ptrdiff_t best = steps;
  for (std::ptrdiff_t k = 0; k <= 2 * steps; ++k) {
    if (smoothed(k) > smoothed(best)) best = k;
  }
  edge.fraction = fractions[static_cast<std::size_t>(best)], edge.points = points[static_cast<std::size_t>(best)];
  edge.shift_s = static_cast<double>(best - steps) / grid_hz_;
  if (edge.fraction < kFits) return std::nullopt;
  return edge;
}

std::vector<PairEdge> PeopleMatcher::edges() const {
  std::vector<PairEdge> found;
  for (std::size_t a = 0; a < cameras_.size(); ++a) {
    for (std::size_t b = a + 1; b < cameras_.size(); ++b) {
      for (std::size_t i = 0; i < std::min(kMaxPeople, cameras_[a].people.size()); ++i) {
        for (std::size_t k = 0; k < std::min(kMaxPeople, cameras_[b].people.size()); ++k) {
          stop_point();
          if (auto edge = relate_people({.camera_a = a, .person_a = i, .camera_b = b, .person_b = k})) found.push_back(*edge);
        }
      }
    }
  }
  std::stable_sort(found.begin(), found.end(), [](const PairEdge& x, const PairEdge& y) { return x.support() > y.support(); });
  return found;
}

/// Whether two identities can be one: none of their people are in one camera at the same time.
bool PeopleMatcher::may_be_one(const PeopleMatch& match, int a, int b) const {
  for (std::size_t c = 0; c < cameras_.size(); ++c) {
    for (std::size_t i = 0; i < match.identity[c].size(); ++i) {
      for (std::size_t k = 0; match.identity[c][i] == a && k < match.identity[c].size(); ++k) {
        const ImagePerson &x = cameras_[c].people[i], &y = cameras_[c].people[k];
        if (match.identity[c][k] == b && x.first < y.end() && y.first < x.end()) return false;
      }
    }
  }
  return true;
}

/// The most surely related people are one first, and put their cameras on one clock; what contradicts them is not taken.
PeopleMatch PeopleMatcher::run() {
  const std::size_t n = cameras_.size();
  PeopleMatch match;
  match.agreement.assign(n, std::vector<double>(n, 0));
  for (const CameraPeople& camera : cameras_) {
    auto& own = match.identity.emplace_back(camera.people.size());  // each their own at first
    std::iota(own.begin(), own.end(), match.people);
    match.people += static_cast<int>(own.size());
  }
  std::vector<std::size_t> group(n);
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::vector<double> shift(n, 0);
  for (const PairEdge& edge : edges()) {
    const std::size_t a = edge.camera_a, b = edge.camera_b;
    if (group[a] == group[b] && std::abs(edge.shift_s - (shift[b] - shift[a])) > kSameTime / grid_hz_) continue;
    const int kept = match.identity[a][edge.person_a], joined_person = match.identity[b][edge.person_b];
    if (kept != joined_person && !may_be_one(match, kept, joined_person)) continue;
    for (auto& own : match.identity) std::replace(own.begin(), own.end(), joined_person, kept);
    match.agreement[a][b] = match.agreement[b][a] = std::max(match.agreement[a][b], edge.fraction);
    if (group[a] == group[b]) continue;
    const double by = edge.shift_s + shift[a] - shift[b];  // all of b's group moves so that b fits to a
    const std::size_t joined = group[b];
    for (std::size_t c = 0; c < n; ++c) {
      if (group[c] == joined) shift[c] += by, group[c] = group[a];
    }
  }
  for (std::size_t c = 0; c < n; ++c)
    match.offsets_s.push_back(cameras_[c].offset_s + (group[c] == group[0] ? shift[c] - shift[0] : 0));
  count_shared(match);
  return match;
}

/// Numbers those who are in several cameras from 0; the others get −1.
void PeopleMatcher::count_shared(PeopleMatch& match) {
  std::vector<int> number(static_cast<std::size_t>(match.people), -1), seen_by(number.size(), 0);
  for (const auto& own : match.identity) {
    std::vector<int> distinct = own;
    std::sort(distinct.begin(), distinct.end());
    distinct.erase(std::unique(distinct.begin(), distinct.end()), distinct.end());
    for (const int identity : distinct) ++seen_by[static_cast<std::size_t>(identity)];
  }
  match.people = 0;
  for (auto& own : match.identity) {
    for (int& identity : own) {
      const auto i = static_cast<std::size_t>(identity);
      if (seen_by[i] >= 2 && number[i] < 0) number[i] = match.people++;
      identity = number[i];
    }
  }
}

}  // namespace

PeopleMatch match_people(const std::vector<CameraPeople>& cameras, double max_offset_s, std::uint64_t seed) {
  return PeopleMatcher(cameras, max_offset_s, seed).run();
}

}  // namespace marey::calibrate::people

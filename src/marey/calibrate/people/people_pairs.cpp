#include "marey/calibrate/people/people_pairs.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "marey/calibrate/two_views.h"
#include "marey/core/stop.h"

namespace marey::calibrate::people {
namespace {

constexpr double kMaxShift_s = 10;       // unswept: between the starts of two cameras
constexpr double kMinOverlap_s = 0.5;    // unswept
constexpr std::size_t kPeaks = 5;        // unswept: shifts whose geometry is tried
constexpr std::size_t kMaxPoints = 240;  // unswept: of two views, that are related
constexpr std::size_t kMinPoints = 40;   // unswept
constexpr int kDraws = 400;              // unswept: of RANSAC
constexpr double kFits = 0.6;            // unswept: share of points that fit when it is one person at the right shift
constexpr double kMinScore = 3;          // unswept: of a shift's agreement, standard normal
constexpr std::size_t kMaxPeople = 6;    // unswept: of a camera, the longest seen, that are compared
constexpr double kNoiseFactor = 1.5;     // unswept: times what the points state

/// How high each point of a body is in its image, in sizes of the body about its middle: the same from all sides.
std::vector<std::vector<double>> heights_of(const ImagePerson& person, double rate_hz, double grid_hz) {
  const auto steps = static_cast<std::size_t>(static_cast<double>(person.frames.size() - 1) / rate_hz * grid_hz) + 1;
  std::size_t count = 0;
  for (const auto& frame : person.frames) count = std::max(count, frame.size());
  std::vector<std::vector<double>> heights(steps, std::vector<double>(count, std::nan("")));
  for (std::size_t s = 0; s < steps; ++s) {
    const double frame = static_cast<double>(person.first) + static_cast<double>(s) / grid_hz * rate_hz;
    double sum = 0, squares = 0, n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const auto point = person.at(frame, i);
      if (!point) continue;
      heights[s][i] = point->y();
      sum += point->y(), squares += point->y() * point->y(), n += 1;
    }
    if (n < 5) continue;
    const double mean = sum / n, deviation = std::sqrt(std::max(1e-9, squares / n - mean * mean));
    for (double& height : heights[s]) height = (height - mean) / deviation;
  }
  return heights;
}

/// Correlation of how two bodies' points go up and down, b's samples moved by `lag`, as a standard normal deviate (Fisher).
double agreement(const std::vector<std::vector<double>>& a, const std::vector<std::vector<double>>& b, std::ptrdiff_t lag,
                 std::ptrdiff_t minimum) {
  const std::ptrdiff_t begin = std::max<std::ptrdiff_t>(0, lag), end = std::min(std::ssize(a), std::ssize(b) + lag);
  if (end - begin < minimum) return 0;
  double ab = 0, aa = 0, bb = 0;
  for (std::size_t i = 0; i < std::min(a.front().size(), b.front().size()); ++i) {
    double n = 0, sa = 0, sb = 0, saa = 0, sbb = 0, sab = 0;
    for (std::ptrdiff_t s = begin; s < end; ++s) {
      const double x = a[static_cast<std::size_t>(s)][i], y = b[static_cast<std::size_t>(s - lag)][i];
      if (std::isnan(x) || std::isnan(y)) continue;
      n += 1, sa += x, sb += y, saa += x * x, sbb += y * y, sab += x * y;
    }
    if (n < static_cast<double>(minimum)) continue;
    ab += sab - sa * sb / n, aa += saa - sa * sa / n, bb += sbb - sb * sb / n;
  }
  if (!(aa > 0 && bb > 0)) return 0;
  const double r = std::clamp(ab / std::sqrt(aa * bb), -0.9999, 0.9999);
  return std::atanh(r) * std::sqrt(static_cast<double>(end - begin) - 3.0 > 1 ? static_cast<double>(end - begin) - 3.0 : 1.0);
}

struct PairEdge {
  std::size_t camera_a = 0, person_a = 0, camera_b = 0, person_b = 0;
  double shift_s = 0;  ///< added to b's times, beyond its offset
  double fraction = 0, points = 0;
  double support() const { return fraction * points; }
};

class PeopleMatcher {
 public:
  PeopleMatcher(const std::vector<CameraPeople>& cameras, bool find_offsets, std::uint64_t seed)
      : cameras_(cameras), find_offsets_(find_offsets), seed_(seed) {
    for (const CameraPeople& camera : cameras) grid_hz_ = std::max(grid_hz_, camera.rate_hz);
  }

  PeopleMatch run();

 private:
  struct Fit {
    double fraction = 0, points = 0;
  };

  bool moves(std::size_t a, std::size_t b) const {
    return find_offsets_ && !(cameras_[a].offset_known && cameras_[b].offset_known);
  }
  Fit fit(const PairEdge& edge, double shift_s) const;
  std::vector<double> shifts(const PairEdge& edge) const;
  std::optional<PairEdge> relate_people(PairEdge edge) const;
  std::vector<PairEdge> edges() const;

  const std::vector<CameraPeople>& cameras_;
  bool find_offsets_;
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
  if (shared.size() < kMinPoints) return {};
  std::vector<WandPair> pairs;
  const std::size_t count = std::min(kMaxPoints, shared.size());
  constexpr double kGolden = 0.6180339887498949;
  for (std::size_t k = 0; k < count; ++k) {  // spread over time and over the points
    const double at = std::fmod(static_cast<double>(k + 1) * kGolden, 1.0);
    const auto& [here, there] = shared[static_cast<std::size_t>(at * static_cast<double>(shared.size()))];
    const auto at_a = a.lens.bearing(here), at_b = b.lens.bearing(there);
    if (at_a && at_b) pairs.push_back({{*at_a}, {*at_b}});
  }
  const auto sigma = [](const CameraPeople& camera, const ImagePerson& person) {
    return kNoiseFactor * person.sigma_px / geometry::focal_of(camera.lens.lens()).x();
  };
  TwoViewOptions how{.markers = 1, .reversible = false, .sigma_a = sigma(a, one), .sigma_b = sigma(b, other), .seed = seed_};
  how.max_draws = kDraws;
  const auto views = relate(pairs, how);
  return {views && !views->plane && !views->one_position ? views->fraction : 0, static_cast<double>(shared.size())};
}

/// Those at which the bodies move alike, the best first; the one that the clocks say where it is known.
std::vector<double> PeopleMatcher::shifts(const PairEdge& edge) const {
  if (!moves(edge.camera_a, edge.camera_b)) return {0};
  const CameraPeople &a = cameras_[edge.camera_a], &b = cameras_[edge.camera_b];
  const ImagePerson &one = a.people[edge.person_a], &other = b.people[edge.person_b];
  const auto at_a = heights_of(one, a.rate_hz, grid_hz_), at_b = heights_of(other, b.rate_hz, grid_hz_);
  const double begin = static_cast<double>(one.first) / a.rate_hz + a.offset_s -
                       (static_cast<double>(other.first) / b.rate_hz + b.offset_s);  // b's first sample moves to a's
  const auto minimum = static_cast<std::ptrdiff_t>(kMinOverlap_s * grid_hz_);
  const auto shift_of = [&](std::ptrdiff_t lag) { return begin + static_cast<double>(lag) / grid_hz_; };
  std::vector<std::pair<double, double>> peaks;  // agreement, shift
  double before = 0, here = 0;
  for (std::ptrdiff_t lag = -std::ssize(at_b); lag <= std::ssize(at_a) + 1; ++lag) {
    const double after = std::abs(shift_of(lag)) <= kMaxShift_s ? agreement(at_a, at_b, lag, minimum) : 0;
    if (here > before && here >= after && here > kMinScore) peaks.emplace_back(here, shift_of(lag - 1));
    before = here, here = after;
  }
  std::stable_sort(peaks.begin(), peaks.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
  if (peaks.size() > kPeaks) peaks.resize(kPeaks);
  std::vector<double> shifts;
  for (const auto& [score, shift] : peaks) shifts.push_back(shift);
  return shifts;
}

/// The shift at which most points fit: the best peak, then climbed in steps down to half a frame.
std::optional<PairEdge> PeopleMatcher::relate_people(PairEdge edge) const {
  const auto attempt = [&](double shift_s) {
    const Fit found = fit(edge, shift_s);
    if (found.fraction > edge.fraction) edge.fraction = found.fraction, edge.points = found.points, edge.shift_s = shift_s;
  };
  for (const double shift : shifts(edge)) attempt(shift);
  if (edge.fraction > 0.5 * kFits && moves(edge.camera_a, edge.camera_b)) {
    for (const double frames : {2.0, 1.0, 0.5}) {
      const double from = edge.shift_s;
      attempt(from - frames / grid_hz_);
      attempt(from + frames / grid_hz_);
    }
  }
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

PeopleMatch PeopleMatcher::run() {
  const std::size_t n = cameras_.size();
  PeopleMatch match;
  match.agreement.assign(n, std::vector<double>(n, 0));
  for (const CameraPeople& camera : cameras_) match.identity.emplace_back(camera.people.size(), -1);
  std::vector<std::size_t> group(n);
  std::iota(group.begin(), group.end(), std::size_t{0});
  std::vector<double> shift(n, 0);
  const auto taken = [&](std::size_t camera, int identity, std::size_t person) {  // by another who is there at the same time
    for (std::size_t p = 0; p < match.identity[camera].size(); ++p) {
      if (p == person || match.identity[camera][p] != identity) continue;
      const ImagePerson &x = cameras_[camera].people[p], &y = cameras_[camera].people[person];
      if (x.first < y.end() && y.first < x.end()) return true;
    }
    return false;
  };
  for (const PairEdge& edge : edges()) {
    const std::size_t a = edge.camera_a, b = edge.camera_b;
    if (group[a] == group[b] && std::abs(edge.shift_s - (shift[b] - shift[a])) > 2 / grid_hz_) continue;  // another time
    int &at_a = match.identity[a][edge.person_a], &at_b = match.identity[b][edge.person_b];
    if (at_a >= 0 && at_b >= 0 && at_a != at_b) continue;
    const int identity = at_a >= 0 ? at_a : at_b >= 0 ? at_b : match.people;
    if (taken(a, identity, edge.person_a) || taken(b, identity, edge.person_b)) continue;
    if (identity == match.people) ++match.people;
    at_a = at_b = identity;
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
  return match;
}

}  // namespace

PeopleMatch match_people(const std::vector<CameraPeople>& cameras, bool find_offsets, std::uint64_t seed) {
  return PeopleMatcher(cameras, find_offsets, seed).run();
}

}  // namespace marey::calibrate::people

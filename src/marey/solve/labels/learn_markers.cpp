#include "marey/solve/labels/learn_markers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/Eigenvalues>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/solve/labels/four_points.h"

namespace marey::solve::labels {
namespace {

constexpr std::size_t kMaxInstants = 1500;  // of a recording, evenly spread
constexpr double kStill = 0.010;            // m: distances that vary by less
constexpr double kStillFraction = 0.6;      // of all: with more the subject stood still
constexpr double kSided = 0.01;             // m: what stands out less of a plane has no side
constexpr std::size_t kRequested = 6;       // neighbours, the steadiest, of which sides are compared
constexpr double kUnknownDeviation = 0.25;  // m: of two markers that were never seen together
constexpr double kMinMarkersM = 0.010;
constexpr double kThin = 0.010;        // m: RMS, of a layout that is a line or a plane
constexpr double kMinTogether = 0.25;  // of all pairs of markers

std::string without_prefix(const std::string& label, const std::string& prefix) {
  return label.starts_with(prefix) ? label.substr(prefix.size()) : label;
}

/// "Anna:" where all labels begin so.
std::string common_prefix(const Recording& recording) {
  std::optional<std::string> prefix;
  for (const TrackColumns& track : recording.tracks()) {
    if (track.name.label.empty()) continue;
    const std::size_t colon = track.name.label.find(':');
    const std::string its = colon == std::string::npos ? "" : track.name.label.substr(0, colon + 1);
    if (prefix && *prefix != its) return {};
    prefix = its;
  }
  return prefix.value_or("");
}

std::map<std::string, const TrackColumns*> labelled_tracks(const Recording& recording) {
  const std::string prefix = common_prefix(recording);
  std::map<std::string, const TrackColumns*> tracks;
  for (const TrackColumns& track : recording.tracks()) {
    if (track.name.label.empty() || track.empty()) continue;
    if (!tracks.emplace(without_prefix(track.name.label, prefix), &track).second)
      throw Error("{}: two tracks are called \"{}\"; give one of them another name", recording.header.name, track.name.label);
  }
  return tracks;
}

/// Sums of the distances of each two markers over one recording.
struct DistanceSums {
  std::vector<double> sum, squares;
  std::vector<int> count;

  explicit DistanceSums(std::size_t pairs) : sum(pairs), squares(pairs), count(pairs) {}
  double mean(std::size_t pair) const { return sum[pair] / count[pair]; }
  double variance(std::size_t pair) const { return std::max(squares[pair] / count[pair] - mean(pair) * mean(pair), 0.0); }
};

using Posture = std::vector<std::optional<Vector<3>>>;

Posture posture_at(const std::vector<const TrackColumns*>& tracks, std::size_t instant) {
  Posture locations(tracks.size());
  for (std::size_t m = 0; m < tracks.size(); ++m) {
    if (tracks[m] == nullptr) continue;
    const auto row = tracks[m]->row_at(static_cast<std::int32_t>(instant));
    if (row && (tracks[m]->provenance()[*row] == Provenance::measured || tracks[m]->provenance()[*row] == Provenance::filled))
      locations[m] = tracks[m]->position(*row);
  }
  return locations;
}

DistanceSums sums_of(const std::vector<const TrackColumns*>& tracks, std::size_t instants) {
  DistanceSums sums(tracks.size() * (tracks.size() - 1) / 2);
  const std::size_t step = std::max<std::size_t>(1, instants / kMaxInstants);
  for (std::size_t i = 0; i < instants; i += step) {
    const Posture locations = posture_at(tracks, i);
    for (std::size_t a = 1; a < locations.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        if (!locations[a] || !locations[b]) continue;
        const double distance = (*locations[a] - *locations[b]).norm();
        const std::size_t pair = LearnedMarkers::index_of(a, b);
        sums.sum[pair] += distance;
        sums.squares[pair] += distance * distance;
        ++sums.count[pair];
      }
    }
  }
  return sums;
}

/// By how much the distances of one recording are larger than those of the first, all pairs together: in least squares.
double size_against(const DistanceSums& sums, const DistanceSums& first) {
  double product = 0, square = 0;
  for (std::size_t pair = 0; pair < sums.sum.size(); ++pair) {
    if (sums.count[pair] == 0 || first.count[pair] == 0) continue;
    product += sums.mean(pair) * first.mean(pair);
    square += first.mean(pair) * first.mean(pair);
  }
  return square > 0 ? product / square : 1;
}

/// How large the subjects are, against the first one's: by recording.
struct Sizes {
  std::vector<double> of;
  double mean = 0;
};

Sizes sizes_of(const std::vector<DistanceSums>& sums, bool scaled) {
  Sizes sizes{.of = std::vector<double>(sums.size(), 1.0)};
  for (std::size_t r = 0; r < sums.size(); ++r) {
    if (scaled) sizes.of[r] = size_against(sums[r], sums[0]);
    sizes.mean += sizes.of[r] / static_cast<double>(sums.size());
  }
  return sizes;
}

/// The distances' means and deviations over all recordings, brought to the mean size; and whether the subject moved. Throws Error
/// where barely any two markers are seen together.
void learn_distances(const std::vector<DistanceSums>& sums, const Sizes& sizes, LearnedMarkers& learned) {
  std::size_t still = 0, known = 0;
  for (std::size_t pair = 0; pair < sums[0].sum.size(); ++pair) {
    double mean = 0, square = 0, within = 0;
    int takes = 0;
    for (std::size_t r = 0; r < sums.size(); ++r) {
      if (sums[r].count[pair] == 0) continue;
      const double scale = sizes.mean / sizes.of[r], its = scale * sums[r].mean(pair),
                   varies = scale * scale * sums[r].variance(pair);
      mean += its, square += its * its + varies, within += varies, ++takes;
    }
    if (takes == 0) {
      learned.distances.push_back({0.5, kUnknownDeviation});
      continue;
    }
    mean /= takes;
    learned.distances.push_back({mean, std::sqrt(std::max(square / takes - mean * mean, 0.0))});
    ++known;
    still += std::sqrt(within / takes) < kStill;
  }
  if (static_cast<double>(known) < kMinTogether * static_cast<double>(learned.distances.size()))
    throw Error("{} of {} pairs of markers are seen together in any frame; distances between the others are not known", known,
                learned.distances.size());
  learned.moves = static_cast<double>(still) < kStillFraction * static_cast<double>(known);
}

std::vector<std::string> labels_of(std::span<const Recording> recordings, const LearnOptions& options) {
  if (!options.labels.empty() && !options.as_far_as_there) return options.labels;
  std::vector<std::string> labels;
  for (const Recording& recording : recordings) {
    for (const auto& [label, track] : labelled_tracks(recording)) {
      if (std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
    }
  }
  if (!options.labels.empty())
    std::erase_if(labels, [&](const std::string& label) {
      return std::find(options.labels.begin(), options.labels.end(), label) == options.labels.end();
    });
  return labels;
}

void require_all(const std::vector<std::vector<const TrackColumns*>>& tracks, const std::vector<std::string>& labels,
                 const std::string& name) {
  std::vector<std::string> missing;
  for (std::size_t m = 0; m < labels.size(); ++m) {
    if (std::all_of(tracks.begin(), tracks.end(), [&](const auto& of) { return of[m] == nullptr; })) missing.push_back(labels[m]);
  }
  if (!missing.empty())
    throw Error("{}: has no marker {}; leave it out of the set, or learn from a recording that has it", name,
                fmt::join(missing, ", "));
  if (labels.size() < 4) throw Error("{}: {} markers with names; a set takes four or more", name, labels.size());
}

/// The instant at which most are seen, as a posture; one hidden then is where the nearest of its distances put it.
std::vector<Vector<3>> fullest_posture(const std::vector<const TrackColumns*>& tracks, std::size_t instants) {
  Posture best(tracks.size());
  std::ptrdiff_t maximum = -1;
  for (std::size_t i = 0; i < instants; ++i) {
    Posture locations = posture_at(tracks, i);
    const auto detected =
        std::count_if(locations.begin(), locations.end(), [](const auto& location) { return location.has_value(); });
    if (detected > maximum) maximum = detected, best = std::move(locations);
  }
  std::vector<Vector<3>> locations;
  Vector<3> mean = Vector<3>::Zero();
  for (const auto& location : best) {
    if (location) mean += *location / static_cast<double>(std::max<std::ptrdiff_t>(maximum, 1));
  }
  for (const auto& location : best) locations.push_back(location ? Vector<3>(*location - mean) : Vector<3>::Zero());
  return locations;
}

/// How far the markers of a posture reach, RMS in m, along its three axes; the least first. One without a place is ignored.
Vector<3> extents_of(const std::vector<Vector<3>>& locations) {
  Vector<3> mean = Vector<3>::Zero();
  double count = 0;
  for (const Vector<3>& location : locations) {
    if (!location.isZero(0)) mean += location, ++count;
  }
  Matrix<3> squares = Matrix<3>::Zero();
  for (const Vector<3>& location : locations) {
    if (!location.isZero(0)) squares += (location - mean / count) * (location - mean / count).transpose() / count;
  }
  return Eigen::SelfAdjointEigenSolver<Matrix<3>>(squares).eigenvalues().cwiseMax(0).cwiseSqrt();
}

/// Of how many fours of neighbours two postures agree on the side, less those on which they do not.
int agreement(const std::vector<Vector<3>>& one, const std::vector<Vector<3>>& other,
              const std::vector<std::vector<std::size_t>>& near) {
  int sum = 0;
  for (std::size_t m = 0; m < near.size(); ++m) {
    const auto& its = near[m];
    for (std::size_t i = 2; i < its.size(); ++i) {
      for (std::size_t j = 1; j < i; ++j) {
        for (std::size_t k = 0; k < j; ++k) {
          const double here = signed_height({one[m], one[its[i]], one[its[j]], one[its[k]]});
          const double there = signed_height({other[m], other[its[i]], other[its[j]], other[its[k]]});
          if (std::abs(here) > kSided && std::abs(there) > kSided) sum += here * there > 0 ? 1 : -1;
        }
      }
    }
  }
  return sum;
}

/// The posture that agrees best with all others: of one in whose recording two names are exchanged the rest should not suffer.
std::size_t max_agreed(const std::vector<std::vector<Vector<3>>>& postures, const LearnedMarkers& learned) {
  std::vector<std::vector<std::size_t>> near(learned.size());
  for (std::size_t m = 0; m < learned.size(); ++m) {
    for (std::size_t other = 0; other < learned.size(); ++other) {
      if (other != m) near[m].push_back(other);
    }
    std::stable_sort(near[m].begin(), near[m].end(), [&](std::size_t a, std::size_t b) {
      return learned.between(m, a).deviation < learned.between(m, b).deviation;
    });
    if (near[m].size() > kRequested) near[m].resize(kRequested);
  }
  std::size_t best = 0;
  int maximum = std::numeric_limits<int>::min();
  for (std::size_t r = 0; r < postures.size(); ++r) {
    int sum = 0;
    for (const auto& other : postures) sum += agreement(postures[r], other, near);
    if (sum > maximum) maximum = sum, best = r;
  }
  return best;
}

}  // namespace

LearnedMarkers learn_markers(std::span<const Recording> recordings, const LearnOptions& options) {
  LearnedMarkers learned;
  learned.labels = labels_of(recordings, options);
  learned.scaled = options.scaled;
  std::vector<std::vector<const TrackColumns*>> tracks;
  std::vector<DistanceSums> sums;
  for (const Recording& recording : recordings) {
    const auto named = labelled_tracks(recording);
    auto& of = tracks.emplace_back();
    for (const std::string& label : learned.labels) {
      const auto found = named.find(label);
      of.push_back(found == named.end() ? nullptr : found->second);
    }
  }
  require_all(tracks, learned.labels, recordings.size() == 1 ? recordings[0].header.name : "the recordings");
  for (std::size_t r = 0; r < recordings.size(); ++r) sums.push_back(sums_of(tracks[r], recordings[r].instants().size()));
  const Sizes sizes = sizes_of(sums, options.scaled);
  learn_distances(sums, sizes, learned);
  std::vector<std::vector<Vector<3>>> postures;
  for (std::size_t r = 0; r < recordings.size(); ++r)
    postures.push_back(fullest_posture(tracks[r], recordings[r].instants().size()));
  const std::size_t chosen = max_agreed(postures, learned);
  learned.locations = std::move(postures[chosen]);
  for (Vector<3>& location : learned.locations) location *= sizes.mean / sizes.of[chosen];
  if (extents_of(learned.locations)[1] < kThin)
    throw Error("the {} markers lie in one line, or on one spot: names cannot be reported by how they lie", learned.size());
  return learned;
}

bool is_flat(const LearnedMarkers& learned) {
  return extents_of(learned.locations)[0] < kThin;
}

std::vector<std::string> too_near_for_markers(const LearnedMarkers& learned) {
  std::vector<std::string> near;
  for (std::size_t a = 0; a < learned.size(); ++a) {
    for (std::size_t b = 0; b < learned.size(); ++b) {
      if (a == b || learned.between(a, b).mean >= kMinMarkersM) continue;
      near.push_back(learned.labels[a]);
      break;
    }
  }
  return near;
}

}  // namespace marey::solve::labels

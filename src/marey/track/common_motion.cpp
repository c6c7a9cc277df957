// A turn of the camera moves near and far alike by the same number of pixels. Each pair of an expected and a seen person of the
// same size proposes a shift; the shift under which most targets find an observation wins, if it explains clearly more of them than
// no shift does. Cost: pairs × people, bounded by taking the largest people only.
#include "marey/track/common_motion.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace marey::track {
namespace {

constexpr std::size_t most_people = 40;
constexpr std::size_t fewest_people = 3;
constexpr double kFarthestTurn = 0.7;    // sizes; a camera does not turn more between two frames
constexpr double same_size = 0.25;       // difference of logarithms
constexpr double tolerance = 0.08;       // sizes; standard deviation of one person about the common motion
constexpr double clearly_better = 0.25;  // share of the people by which a shift must beat none

std::vector<Sighting> largest(std::span<const Sighting> all) {
  std::vector<Sighting> kept(all.begin(), all.end());
  std::sort(kept.begin(), kept.end(), [](const Sighting& a, const Sighting& b) {
    return std::tuple(-a.size, a.place.x(), a.place.y()) < std::tuple(-b.size, b.place.x(), b.place.y());
  });
  if (kept.size() > most_people) kept.resize(most_people);
  return kept;
}

struct Proposal {
  std::size_t person;
  double size;
  Vector<2> shift;
};

struct Support {
  double sum = 0;
  Vector<2> mean = Vector<2>::Zero();
};

/// How many targets find an observation under `shift`, and the mean of their own shifts. Proposals are grouped by person.
Support support_of(const Vector<2>& shift, std::span<const Proposal> proposals) {
  Support support;
  double weights = 0;
  for (std::size_t i = 0; i < proposals.size();) {
    double best = 0;
    Vector<2> own = Vector<2>::Zero();
    const std::size_t person = proposals[i].person;
    for (; i < proposals.size() && proposals[i].person == person; ++i) {
      const double away = (proposals[i].shift - shift).squaredNorm() / std::pow(tolerance * proposals[i].size, 2);
      const double fit = std::exp(-away / 2);
      if (fit > best) {
        best = fit;
        own = proposals[i].shift;
      }
    }
    support.sum += best;
    support.mean += best * own;
    weights += best;
  }
  if (weights > 0) support.mean /= weights;
  return support;
}

}  // namespace

Vector<2> common_motion(std::span<const Sighting> expected, std::span<const Sighting> seen) {
  const std::vector<Sighting> people = largest(expected);
  std::vector<Proposal> proposals;
  std::size_t found = 0;
  for (std::size_t person = 0; person < people.size(); ++person) {
    const std::size_t before = proposals.size();
    for (const Sighting& one : seen) {
      const Vector<2> shift = one.place - people[person].place;
      if (std::abs(std::log(one.size / people[person].size)) > same_size || shift.norm() > kFarthestTurn * people[person].size)
        continue;
      proposals.push_back({person, people[person].size, shift});
    }
    found += proposals.size() > before;
  }
  if (found < fewest_people) return Vector<2>::Zero();
  const Support still = support_of(Vector<2>::Zero(), proposals);
  Support best = still;
  for (const Proposal& proposal : proposals) {
    const Support support = support_of(proposal.shift, proposals);
    if (support.sum > best.sum) best = support;
  }
  const double margin = clearly_better * static_cast<double>(found);
  return best.sum >= still.sum + margin ? best.mean : Vector<2>::Zero();
}

}  // namespace marey::track

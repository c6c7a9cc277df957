#include "marey/calibrate/people/image_people.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>

#include "marey/geometry/median.h"

namespace marey::calibrate::people {
namespace {

constexpr double kMinVisible = 0.5;    // by definition: more likely seen than not
constexpr double kMinLasting_s = 0.5;  // unswept: of a person that counts
constexpr double kMaxAbsent_s = 0.25;  // unswept: between frames of one person
constexpr double kMaxMoved = 0.35;     // unswept: of the body's size between two frames
constexpr std::size_t kMinPoints = 5;  // unswept: of a frame that counts

using Points = std::vector<std::optional<Vector<2>>>;

double size_of(const Points& points) {
  Vector<2> low = Vector<2>::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& point : points) {
    if (point) low = low.cwiseMin(*point), high = high.cwiseMax(*point);
  }
  return (high - low).maxCoeff();
}

struct Open {
  ImagePerson person;
  Points last;
  std::size_t observed = 0;  // the last frame
  std::size_t count = 0;
  std::vector<double> sigmas;
};

struct Link {
  double distance = 0;
  std::size_t person = 0, open = 0;
};

/// People of a frame to those who are followed, the nearest pair first.
std::vector<Link> links(const std::vector<Points>& people, const std::vector<Open>& open) {
  std::vector<Link> all;
  for (std::size_t p = 0; p < people.size(); ++p) {
    for (std::size_t o = 0; o < open.size(); ++o) {
      const double moved = people[p].empty() ? kMaxMoved : distance_in_sizes(open[o].last, people[p]);
      if (moved < kMaxMoved) all.push_back({moved, p, o});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Link& a, const Link& b) { return a.distance < b.distance; });
  return all;
}

void add(Open& open, std::size_t frame, Points points, const std::vector<double>& sigmas) {
  open.person.frames.resize(frame - open.person.first + 1);
  open.person.frames.back() = points;
  open.last = std::move(points);
  open.observed = frame;
  ++open.count;
  open.sigmas.insert(open.sigmas.end(), sigmas.begin(), sigmas.end());
}

}  // namespace

std::vector<std::optional<Vector<2>>> sure_points(const Keypoints<2>& person, std::vector<double>* sigmas) {
  Points points(person.points.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto& point = person.points[i];
    if (!point || point->visibility * point->presence < kMinVisible || !point->position.allFinite()) continue;
    points[i] = point->position;
    if (sigmas != nullptr) sigmas->push_back(std::sqrt(std::sqrt(std::max(0.0, point->covariance.determinant()))));
    ++count;
  }
  return count >= kMinPoints ? points : Points{};
}

double distance_in_sizes(const std::vector<std::optional<Vector<2>>>& a, const std::vector<std::optional<Vector<2>>>& b) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
    if (a[i] && b[i]) sum += (*a[i] - *b[i]).norm(), ++count;
  }
  return count == 0 ? std::numeric_limits<double>::infinity() : sum / count / std::max(1.0, size_of(a));
}

std::optional<Vector<2>> ImagePerson::at(double frame, std::size_t point) const {
  const double at = frame - static_cast<double>(first);
  if (at < 0 || at > static_cast<double>(frames.size()) - 1) return std::nullopt;
  const auto before = static_cast<std::size_t>(at), after = std::min(before + 1, frames.size() - 1);
  const double fraction = at - static_cast<double>(before);
  const auto shown = [&](std::size_t k) { return frames[k].empty() ? std::nullopt : frames[k][point]; };
  const auto a = shown(before), b = fraction > 0 ? shown(after) : a;
  if (!a || !b) return std::nullopt;
  return Vector<2>(*a + fraction * (*b - *a));
}

std::vector<ImagePerson> image_people(const KeypointSequence& sequence, double rate_hz) {
  std::vector<Open> open;
  std::vector<ImagePerson> done;
  const auto end = [&](Open& one) {
    if (static_cast<double>(one.count) < kMinLasting_s * rate_hz) return;
    one.person.sigma_px = std::max(0.5, geometry::median_or(one.sigmas, 1));
    done.push_back(std::move(one.person));
  };
  for (std::size_t k = 0; k < sequence.frames.size(); ++k) {
    std::vector<Points> people;
    std::vector<std::vector<double>> sigmas;
    for (const Keypoints<2>& person : sequence.frames[k]) people.push_back(sure_points(person, &sigmas.emplace_back()));
    std::vector<char> linked(people.size(), 0);
    for (const Link& link : links(people, open)) {
      if (linked[link.person] || open[link.open].observed == k) continue;
      linked[link.person] = 1;
      add(open[link.open], k, people[link.person], sigmas[link.person]);
    }
    for (std::size_t p = 0; p < people.size(); ++p) {
      if (linked[p] || people[p].empty()) continue;
      Open fresh;
      fresh.person.first = k;
      add(fresh, k, people[p], sigmas[p]);
      open.push_back(std::move(fresh));
    }
    for (Open& one : open) {
      if (static_cast<double>(k - one.observed) > kMaxAbsent_s * rate_hz) end(one);
    }
    std::erase_if(open, [&](const Open& one) { return static_cast<double>(k - one.observed) > kMaxAbsent_s * rate_hz; });
  }
  for (Open& one : open) end(one);
  std::stable_sort(done.begin(), done.end(),
                   [](const ImagePerson& a, const ImagePerson& b) { return a.frames.size() > b.frames.size(); });
  return done;
}

std::vector<ImagePerson> mirrored(std::vector<ImagePerson> people, const KeypointSet& set, int width) {
  for (ImagePerson& person : people) {
    for (auto& frame : person.frames) {
      auto other = frame;
      for (std::size_t i = 0; i < frame.size(); ++i) {
        const std::size_t from = i < set.mirrored.size() ? static_cast<std::size_t>(set.mirrored[i]) : i;
        other[i] = from < frame.size() ? frame[from] : std::nullopt;
        if (other[i]) other[i]->x() = width - 1 - other[i]->x();
      }
      frame = std::move(other);
    }
  }
  return people;
}

}  // namespace marey::calibrate::people

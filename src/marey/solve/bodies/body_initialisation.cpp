#include "marey/solve/bodies/body_initialisation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "marey/geometry/layout.h"

namespace marey::solve::bodies {
namespace {

constexpr double kFlattest = 0.15;         // sine of the least angle of a triangle at its first corner
constexpr std::size_t kMaxPairs = 20'000;  // of one edge that are tried
constexpr double kMinDistanceM = 2e-4;     // nothing is known to be nearer
constexpr double kAroundM = 0.5;           // m, within which points count for how dense they lie
constexpr double kRoomM = 2;               // m, within which all points lie at least

/// The points of a candidate, whichever marker each is taken for.
std::vector<int> points_of(const PoseCandidate& candidate) {
  std::vector<int> points;
  for (const auto& point : candidate.point_of) {
    if (point) points.push_back(*point);
  }
  std::sort(points.begin(), points.end());
  return points;
}

double sine_at(const Vector<3>& corner, const Vector<3>& b, const Vector<3>& c) {
  const Vector<3> u = b - corner, v = c - corner;
  return u.cross(v).norm() / std::max(u.norm() * v.norm(), 1e-12);
}

}  // namespace

BodyInitialiser::BodyInitialiser(std::vector<std::vector<Vector<3>>> layouts, double tolerance)
    : layouts_(std::move(layouts)), tolerance_(tolerance) {}

const std::vector<PoseCandidate>& BodyInitialiser::find(std::span<const Vector<3>> points, std::span<const int> required) {
  found_.clear();
  if (points.size() < 3 || required.empty()) return found_;
  double longest = 0;
  for (const int body : required) {
    const auto& layout = layouts_[static_cast<std::size_t>(body)];
    for (const Vector<3>& a : layout) {
      for (const Vector<3>& b : layout) longest = std::max(longest, (a - b).norm());
    }
  }
  sort_pairs(points, longest + 2 * tolerance_);
  for (const int body : required) {
    for (const Edge& edge : rarest_edges(layouts_[static_cast<std::size_t>(body)])) {
      const auto [first, last] = pairs_near(edge.length);
      for (std::size_t i = first; i < std::min(last, first + kMaxPairs); ++i) {
        try_pair(points, body, edge, pairs_[i].a, pairs_[i].b);
        try_pair(points, body, edge, pairs_[i].b, pairs_[i].a);
      }
    }
  }
  return found_;
}

void BodyInitialiser::sort_pairs(std::span<const Vector<3>> points, double longest) {
  pairs_.clear();
  for (int a = 0; a < std::ssize(points); ++a) {
    for (int b = 0; b < a; ++b) {
      const double square = (points[static_cast<std::size_t>(a)] - points[static_cast<std::size_t>(b)]).squaredNorm();
      if (square < longest * longest) pairs_.push_back({std::sqrt(square), a, b});
    }
  }
  std::sort(pairs_.begin(), pairs_.end(), [](const Pair& one, const Pair& other) {
    return std::tie(one.length, one.a, one.b) < std::tie(other.length, other.a, other.b);
  });
}

std::pair<std::size_t, std::size_t> BodyInitialiser::pairs_near(double length) const {
  const auto shorter = [](const Pair& pair, double limit) { return pair.length < limit; };
  const auto first = std::lower_bound(pairs_.begin(), pairs_.end(), length - 2 * tolerance_, shorter);
  const auto last = std::lower_bound(first, pairs_.end(), length + 2 * tolerance_, shorter);
  return {static_cast<std::size_t>(first - pairs_.begin()), static_cast<std::size_t>(last - pairs_.begin())};
}

std::vector<BodyInitialiser::Edge> BodyInitialiser::rarest_edges(const std::vector<Vector<3>>& layout) const {
  std::vector<Edge> edges;
  for (int a = 0; a < std::ssize(layout); ++a) {
    for (int b = 0; b < a; ++b) {
      const double length = (layout[static_cast<std::size_t>(a)] - layout[static_cast<std::size_t>(b)]).norm();
      const auto [first, last] = pairs_near(length);
      edges.push_back({a, b, length, last - first});
    }
  }
  // Of equally rare ones the longest, which fixes the pose best.
  std::stable_sort(edges.begin(), edges.end(), [](const Edge& one, const Edge& other) {
    return one.count != other.count ? one.count < other.count : one.length > other.length;
  });
  // With that many that share no marker, one is whole while a body may still be trusted.
  const int hidden = static_cast<int>(layout.size()) - min_to_initialise(static_cast<int>(layout.size()));
  std::vector<Edge> chosen;
  for (const Edge& edge : edges) {
    const auto apart = [&](const Edge& other) {
      return edge.a != other.a && edge.a != other.b && edge.b != other.a && edge.b != other.b;
    };
    if (static_cast<int>(chosen.size()) <= hidden && std::all_of(chosen.begin(), chosen.end(), apart)) chosen.push_back(edge);
  }
  return chosen;
}

void BodyInitialiser::try_pair(std::span<const Vector<3>> points, int body, const Edge& edge, int p, int q) {
  const auto& layout = layouts_[static_cast<std::size_t>(body)];
  const Vector<3>&a = layout[static_cast<std::size_t>(edge.a)], &b = layout[static_cast<std::size_t>(edge.b)];
  const Vector<3>&at_p = points[static_cast<std::size_t>(p)], &at_q = points[static_cast<std::size_t>(q)];
  int thirds = static_cast<int>(layout.size()) - min_to_initialise(static_cast<int>(layout.size())) + 1;
  for (int c = 0; c < std::ssize(layout) && thirds > 0; ++c) {
    const Vector<3>& third = layout[static_cast<std::size_t>(c)];
    if (c == edge.a || c == edge.b || sine_at(a, b, third) < kFlattest) continue;
    --thirds;
    const double from_a = (third - a).norm(), from_b = (third - b).norm(), maximum = 2 * tolerance_;
    for (int r = 0; r < std::ssize(points); ++r) {
      const Vector<3>& at_r = points[static_cast<std::size_t>(r)];
      if (r == p || r == q || std::abs((at_r - at_p).norm() - from_a) > maximum ||
          std::abs((at_r - at_q).norm() - from_b) > maximum)
        continue;
      confirm(points, body, geometry::rigid_fit(std::array{a, b, third}, std::array{at_p, at_q, at_r}));
    }
  }
}

bool BodyInitialiser::fits_better_mirrored(std::span<const Vector<3>> points, const PoseCandidate& candidate) const {
  std::vector<Vector<3>> mirrored = layouts_[static_cast<std::size_t>(candidate.body)], from, to;
  for (Vector<3>& marker : mirrored) marker.x() = -marker.x();
  for (std::size_t m = 0; m < mirrored.size(); ++m) {
    if (!candidate.point_of[m]) continue;
    from.push_back(mirrored[m]);
    to.push_back(points[static_cast<std::size_t>(*candidate.point_of[m])]);
  }
  const Rigid3 world_from_mirrored = geometry::rigid_fit(from, to);
  const auto is_there = [&](const Vector<3>& marker) {
    const Vector<3> location = world_from_mirrored * marker;
    return std::any_of(points.begin(), points.end(),
                       [&](const Vector<3>& point) { return (point - location).norm() < tolerance_; });
  };
  return std::count_if(mirrored.begin(), mirrored.end(), is_there) > candidate.matched;
}

BodyInitialiser::Triangle BodyInitialiser::rarest_triangle(std::span<const Vector<3>> layout, std::span<const std::size_t> matched,
                                                           std::span<const double> lengths) const {
  std::optional<Triangle> rarest;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const Vector<3>&a = layout[matched[i]], &b = layout[matched[j]];
      const double length = (a - b).norm();
      const auto [first, last] = pairs_near(length);
      const auto own =
          std::count_if(lengths.begin(), lengths.end(), [&](double each) { return std::abs(each - length) < 2 * tolerance_; });
      Triangle triangle{.others = std::max(0.0, static_cast<double>(last - first) - static_cast<double>(own)), .height = 0};
      const Vector<3> along = (a - b) / length;
      for (const std::size_t c : matched) {
        const Vector<3> to = layout[c] - b;
        triangle.height = std::max(triangle.height, (to - along * along.dot(to)).norm());
      }
      const auto rarer = [](const Triangle& one, const Triangle& other) {
        return one.others < other.others || (one.others == other.others && one.height > other.height);
      };
      if (!rarest || rarer(triangle, *rarest)) rarest = triangle;
    }
  }
  return rarest.value_or(Triangle{});
}

/// Pairs of points as long as one edge of the candidate (those there are, without its own), times the thirds to be expected in the
/// ring where a third marker would be, times the chance that as many others have a point where they are due; all as near as the
/// candidate's own distances are to the body's.
double BodyInitialiser::expected_by_chance(std::span<const Vector<3>> points, const PoseCandidate& candidate) const {
  const auto& layout = layouts_[static_cast<std::size_t>(candidate.body)];
  std::vector<std::size_t> matched;
  for (std::size_t m = 0; m < layout.size(); ++m) {
    if (candidate.point_of[m]) matched.push_back(m);
  }
  const auto point_of = [&](std::size_t m) -> const Vector<3>& { return points[static_cast<std::size_t>(*candidate.point_of[m])]; };
  double off = kMinDistanceM;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < matched.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double length = (layout[matched[i]] - layout[matched[j]]).norm(),
                   detected = (point_of(matched[i]) - point_of(matched[j])).norm();
      off = std::max(off, std::abs(detected - length));
      lengths.push_back(detected);
    }
  }
  const auto [others, height] = rarest_triangle(layout, matched, lengths);
  const Vector<3> centre = point_of(matched.front());
  const auto near = std::count_if(points.begin(), points.end(), [&](const Vector<3>& p) { return (p - centre).norm() < kAroundM; });
  const auto all = static_cast<double>(points.size()), own = static_cast<double>(matched.size());
  constexpr double kBall = 4 * std::numbers::pi / 3;  // by definition
  const double density = std::max(0.0, static_cast<double>(near) - own) / (kBall * kAroundM * kAroundM * kAroundM) +
                         (all - own) / (kBall * kRoomM * kRoomM * kRoomM);
  const double fraction = std::min(1.0, off / (2 * tolerance_));
  double expected = 2 * (others + 1) * fraction * 2 * std::numbers::pi * height * 4 * off * off * density;
  const double here = std::min(1.0, density * kBall * off * off * off);
  const auto rest = static_cast<double>(layout.size() - 3);
  for (std::size_t more = 3; more < matched.size(); ++more)
    expected *= here * (rest - static_cast<double>(more - 3)) / static_cast<double>(more - 2);
  return expected;
}

void BodyInitialiser::confirm(std::span<const Vector<3>> points, int body, Rigid3 pose) {
  const auto& layout = layouts_[static_cast<std::size_t>(body)];
  PoseCandidate candidate{.body = body, .world_from_body = pose, .point_of = {}};
  for (int round = 0; round < 2; ++round) {
    const double limit = (round == 0 ? 2 : 1) * tolerance_;
    candidate.point_of.assign(layout.size(), std::nullopt);
    std::vector<Vector<3>> from, to;
    double squares = 0;
    for (std::size_t m = 0; m < layout.size(); ++m) {
      const Vector<3> location = candidate.world_from_body * layout[m];
      double nearest = limit * limit;
      for (int r = 0; r < std::ssize(points); ++r) {
        const double square = (points[static_cast<std::size_t>(r)] - location).squaredNorm();
        if (square < nearest) nearest = square, candidate.point_of[m] = r;
      }
      if (!candidate.point_of[m]) continue;
      from.push_back(layout[m]);
      to.push_back(points[static_cast<std::size_t>(*candidate.point_of[m])]);
      squares += nearest;
    }
    candidate.matched = static_cast<int>(from.size());
    if (candidate.matched < min_to_initialise(static_cast<int>(layout.size()))) return;
    candidate.rms = std::sqrt(squares / candidate.matched);
    candidate.world_from_body = geometry::rigid_fit(from, to);
  }
  if (candidate.matched < std::ssize(layout) && fits_better_mirrored(points, candidate)) return;
  const std::vector<int> mine = points_of(candidate);
  if (std::adjacent_find(mine.begin(), mine.end()) != mine.end()) return;  // one point for two markers
  candidate.by_chance = expected_by_chance(points, candidate);
  for (PoseCandidate& other : found_) {
    if (other.body != body || points_of(other) != mine) continue;
    if (candidate.rms < other.rms) other = candidate;
    return;
  }
  found_.push_back(std::move(candidate));
}

}  // namespace marey::solve::bodies

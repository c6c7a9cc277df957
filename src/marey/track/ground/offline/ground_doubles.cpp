#include "marey/track/ground/offline/ground_doubles.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <optional>
#include <utility>

#include <Eigen/LU>

#include "marey/core/colour.h"
#include "marey/track/ground/offline/encounters.h"
#include "marey/track/ground/offline/ground_join.h"

namespace marey::track::ground::offline {
namespace {

constexpr double kSamePosition = 9.2;  // chi-square of two degrees, 99 %
constexpr double kMaxBridged = 1;      // s without a sample across which a place is distinguished from before and after

/// Where a tracklet was, and how sure that is.
struct PositionThen {
  Vector<2> location = Vector<2>::Zero();
  Matrix<2> spread = Matrix<2>::Identity();
};

/// Goes through a tracklet's samples by growing instant.
class Walker {
 public:
  Walker(const GroundTracklet& of, std::int32_t from, std::span<const Timestamp> times)
      : samples_(of.samples), times_(times), next_(index_from(of.samples, from)) {}

  /// The instant of the next sample; nothing behind the last.
  std::optional<std::int32_t> upcoming() const {
    return next_ < samples_.size() ? std::optional(samples_[next_].instant) : std::nullopt;
  }
  /// The sample of this instant, if there is one; it is passed.
  const GroundSample* take(std::int32_t instant) {
    if (next_ == samples_.size() || samples_[next_].instant != instant) return nullptr;
    return &samples_[next_++];
  }
  /// Between the samples before and after, unless they are far apart in time.
  std::optional<PositionThen> between(std::int32_t instant) const {
    if (next_ == 0 || next_ == samples_.size()) return std::nullopt;
    const GroundSample &a = samples_[next_ - 1], &b = samples_[next_];
    const double whole = seconds(time(b.instant) - time(a.instant)), part = seconds(time(instant) - time(a.instant));
    if (whole > kMaxBridged) return std::nullopt;
    const double fraction = part / whole;
    return PositionThen{a.at() + fraction * (b.at() - a.at()), (1 - fraction) * a.spread() + fraction * b.spread()};
  }

 private:
  Timestamp time(std::int32_t instant) const { return times_[static_cast<std::size_t>(instant)]; }

  std::span<const GroundSample> samples_;
  std::span<const Timestamp> times_;
  std::size_t next_;
};

/// Statistics of two tracklets while both are there.
struct Overlap {
  int compared = 0, together = 0;  // instants
  int alone_a = 0, alone_b = 0;    // observations by a camera of the one without the other
  int both = 0;                    // frames of a camera in which it sees both
};

class Doubles {
 public:
  Doubles(std::vector<GroundTracklet>& tracklets, std::span<const Timestamp> times, const GroundDoubleOptions& options)
      : tracklets_(tracklets), times_(times), options_(options) {}

  /// Merges until nothing is double.
  void merge() {
    by_start_.resize(tracklets_.size());
    std::iota(by_start_.begin(), by_start_.end(), 0);
    std::stable_sort(by_start_.begin(), by_start_.end(), [&](int a, int b) { return first(a) < first(b); });
    for (std::size_t i = 0; i < by_start_.size(); ++i) {
      for (std::size_t j = i + 1; j < by_start_.size(); ++j) {
        const int a = by_start_[i], b = by_start_[j];
        if (gone(a)) break;
        if (gone(b)) continue;
        if (first(b) > last(a)) break;
        if (!are_one(a, b)) continue;
        absorb(a, b);
        j = i;  // it may reach others now
      }
    }
    std::erase_if(tracklets_, [](const GroundTracklet& tracklet) { return tracklet.samples.empty(); });
  }

 private:
  const std::vector<GroundSample>& samples(int i) const { return tracklets_[static_cast<std::size_t>(i)].samples; }
  bool gone(int i) const { return samples(i).empty(); }
  std::int32_t first(int i) const { return samples(i).front().instant; }
  std::int32_t last(int i) const { return samples(i).back().instant; }
  Timestamp time(std::int32_t instant) const { return times_[static_cast<std::size_t>(instant)]; }

  bool are_one(int a, int b) const {
    const std::int32_t from = std::max(first(a), first(b)), to = std::min(last(a), last(b));
    if (to < from || seconds(time(to) - time(from)) < options_.shortest) return false;
    if (far_apart(a, b, from) || far_apart(a, b, to)) return false;
    const Overlap found = overlap(a, b, from, to);
    if (found.compared == 0 || found.together < options_.near * found.compared) return false;
    const int appearances = found.alone_a + found.alone_b + found.both;
    if (found.alone_a + found.alone_b < options_.appearances || found.both > options_.both * appearances) return false;
    return same_colour(a, b, from, to);
  }

  /// At one end of the overlap: spares the inspection at all of it.
  bool far_apart(int a, int b, std::int32_t instant) const {
    const auto nearest = [&](int i) { return samples(i)[std::min(index_from(samples(i), instant), samples(i).size() - 1)].at(); };
    return (nearest(a) - nearest(b)).norm() > 2 * options_.farthest;
  }

  Overlap overlap(int a, int b, std::int32_t from, std::int32_t to) const {
    Overlap found;
    Walker one(tracklets_[static_cast<std::size_t>(a)], from, times_), other(tracklets_[static_cast<std::size_t>(b)], from, times_);
    while (true) {
      const auto next_a = one.upcoming(), next_b = other.upcoming();
      if (!next_a && !next_b) break;
      const std::int32_t now = std::min(next_a.value_or(to + 1), next_b.value_or(to + 1));
      if (now > to) break;
      const GroundSample *x = one.take(now), *y = other.take(now);
      count_cameras(x, y, found);
      const auto p = x != nullptr ? std::optional(PositionThen{x->at(), x->spread()}) : one.between(now);
      const auto q = y != nullptr ? std::optional(PositionThen{y->at(), y->spread()}) : other.between(now);
      if (!p || !q) continue;
      ++found.compared;
      found.together += at_one_position(*p, *q) ? 1 : 0;
    }
    return found;
  }

  static void count_cameras(const GroundSample* x, const GroundSample* y, Overlap& found) {
    const CameraMask a = x != nullptr ? x->cameras : 0, b = y != nullptr ? y->cameras : 0;
    found.both += std::popcount(a & b);
    found.alone_a += std::popcount(a & ~b);
    found.alone_b += std::popcount(b & ~a);
  }

  bool at_one_position(const PositionThen& p, const PositionThen& q) const {
    const Vector<2> apart = p.location - q.location;
    if (apart.norm() > options_.farthest) return false;
    Matrix<2> S = p.spread + q.spread;
    S.diagonal().array() += 2 * options_.disagreement * options_.disagreement;
    return apart.dot(S.inverse() * apart) < kSamePosition;
  }

  std::optional<Appearance> clothing(int i, std::int32_t from, std::int32_t to) const {
    const std::size_t begin = index_from(samples(i), from), end = index_from(samples(i), to + 1);
    return appearance_of(std::span(samples(i)).subspan(begin, end - begin));
  }

  bool same_colour(int a, int b, std::int32_t from, std::int32_t to) const {
    const auto one = clothing(a, from, to), other = clothing(b, from, to);
    if (!one || !other) return true;
    return (perceived(*one) - perceived(*other)).norm() < options_.colours;
  }

  TrackId track_of(int i, std::size_t sample) const {
    const std::vector<GroundTracklet::Run>& runs = tracklets_[static_cast<std::size_t>(i)].runs;
    return std::prev(std::find_if(runs.begin(), runs.end(), [&](const auto& run) { return run.first > sample; }))->track;
  }

  /// All that was seen of either is the first's, which began earlier.
  void absorb(int a, int b) {
    GroundTracklet whole{.runs = {}, .confirmed = true, .samples = {}};
    std::size_t i = 0, j = 0;
    const auto put = [&](const GroundSample& sample, TrackId track) {
      if (whole.runs.empty() || whole.runs.back().track != track) whole.runs.push_back({track, whole.samples.size()});
      whole.samples.push_back(sample);
    };
    while (i < samples(a).size() || j < samples(b).size()) {
      const bool has_a = i < samples(a).size(), has_b = j < samples(b).size();
      if (has_a && has_b && samples(a)[i].instant == samples(b)[j].instant) {
        put(fused(samples(a)[i], samples(b)[j]), track_of(a, i));
        ++i, ++j;
      } else if (has_a && (!has_b || samples(a)[i].instant < samples(b)[j].instant)) {
        put(samples(a)[i], track_of(a, i));
        ++i;
      } else {
        put(samples(b)[j], track_of(b, j));
        ++j;
      }
    }
    whole.goes_on = last(a) >= last(b) && tracklets_[static_cast<std::size_t>(a)].goes_on;
    end_before(b);
    tracklets_[static_cast<std::size_t>(a)] = std::move(whole);
    tracklets_[static_cast<std::size_t>(b)] = {};
  }

  /// What comes before it in the list no longer continues in it.
  void end_before(int i) {
    if (i > 0) tracklets_[static_cast<std::size_t>(i) - 1].goes_on = false;
  }

  static GroundSample fused(const GroundSample& a, const GroundSample& b) {
    const Matrix<2> A = a.spread().inverse(), B = b.spread().inverse();
    const Matrix<2> covariance = (A + B).inverse();
    const Vector<2> location = covariance * (A * a.at() + B * b.at());
    GroundSample sample = a.colour_deviation <= b.colour_deviation ? a : b;
    sample.location = {static_cast<float>(location.x()), static_cast<float>(location.y())};
    sample.covariance = {static_cast<float>(covariance(0, 0)), static_cast<float>(covariance(0, 1)),
                         static_cast<float>(covariance(1, 1))};
    sample.score = std::max(a.score, b.score);
    sample.cameras = a.cameras | b.cameras;
    sample.shared = a.shared && b.shared;
    return sample;
  }

  std::vector<GroundTracklet>& tracklets_;
  std::span<const Timestamp> times_;
  const GroundDoubleOptions& options_;
  std::vector<int> by_start_;
};

}  // namespace

std::vector<GroundTracklet> merge_doubles(std::vector<GroundTracklet> tracklets, std::span<const Timestamp> times,
                                          const GroundDoubleOptions& options) {
  Doubles(tracklets, times, options).merge();
  return tracklets;
}

}  // namespace marey::track::ground::offline

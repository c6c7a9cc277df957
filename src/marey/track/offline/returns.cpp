#include "marey/track/offline/returns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "marey/assign/association_beliefs.h"
#include "marey/assign/successors.h"
#include "marey/geometry/median.h"
#include "marey/track/image/wardrobe.h"

namespace marey::track::offline {
namespace {

using Tracklet = TrackletLog::Tracklet;

constexpr double kClothesFor = 5;                      // s of a tracklet that show what it wears at an end
constexpr int kMinTimeSteps = 8;                       // of a tracklet whose clothes are learned from
constexpr double kMotionFor = 0.8;                     // s that show where an end goes
constexpr double kNearBorder = 0.2, kSoonThere = 1;    // heights, s: one that near or there so soon leaves, or has come
constexpr double kPositionUnsure = 0.25;               // heights along the border, however short the time away
constexpr double kFastest = 5;                         // heights/s
constexpr double kMaxGrown = 0.5;                      // of the logarithm of the height
constexpr double kBandwidth = 1, kAnywhereCounts = 3;  // heights; as many people as come in anywhere, beside those who were seen to
constexpr double kKnown = 0.8;          // probability of a pair by clothes alone, from which on rates of return are learned from it
constexpr double kFading = 0.5;         // of `typically_away`: from then on, this long until e times fewer come back
constexpr double kFirstFraction = 0.3;  // of those who leave, who come back: to begin with,
constexpr double kFirstCounts = 2;      // and as sure as this number of people
constexpr std::array<double, 4> kSpreads{0.4, 0.65, 1,
                                         1.6};  // factors on how far from where they went out people come in: all are tried
constexpr double kSpreadUnsure = 0.7;           // deviation of the logarithm of that, before anything is known
// With few entries, the rate and the density of entries are uncertain, and clothes must suffice. Unswept.
constexpr int kMinComings = 8;
constexpr double kClothesAlone = 5;  // logarithm of the likelihood ratio
constexpr double kAtOnce = 1;        // s at both bounds of the recording, where tracks begin and end of themselves

enum class Side { left, right, top, bottom };

/// Where and when a tracklet crosses the image's border.
struct Crossing {
  double time = 0;      // s
  double location = 0;  // px along the border, from its top left, clockwise
  double size = 1;      // px
  bool of_border = false;
  bool of_recording = false;  // at its bounds
  bool upright = false;       // at the left or right
};

double perimeter(const Box& view) {
  return 2 * (view.width + view.height);
}

double distance_along(double a, double b, const Box& view) {
  const double distance = std::abs(a - b);
  return std::min(distance, perimeter(view) - distance);
}

/// Of the height without those that the border cuts.
double height_near(std::span<const TrackRow> rows, bool tail) {
  std::vector<float> heights;
  for (std::size_t k = 0; k < rows.size() && k < 100; ++k) heights.push_back((tail ? rows[rows.size() - 1 - k] : rows[k]).height);
  return std::max(1.0F, geometry::median(heights));
}

class Crossings {
 public:
  Crossings(const TrackletLog& log, const Box& view, double begin, double end) : log_(log), view_(view), begin_(begin), end_(end) {}

  Crossing of(const Tracklet& rows, bool tail) const {
    const TrackRow& edge = tail ? rows.back() : rows.front();
    Crossing crossing;
    crossing.time = time_of(edge);
    crossing.size = height_near(rows, tail);
    crossing.of_recording = tail ? crossing.time > end_ - kAtOnce : crossing.time < begin_ + kAtOnce;
    const Vector<2> outwards = (tail ? 1 : -1) * velocity(rows, tail);
    const double reach = kNearBorder * crossing.size;
    const std::array<double, 4> left_over{edge.left - view_.left + kSoonThere * std::min(0.0, outwards.x()),
                                          view_.right() - edge.left - edge.width - kSoonThere * std::max(0.0, outwards.x()),
                                          edge.top - view_.top + kSoonThere * std::min(0.0, outwards.y()),
                                          view_.bottom() - edge.top - edge.height - kSoonThere * std::max(0.0, outwards.y())};
    const auto nearest = std::min_element(left_over.begin(), left_over.end());
    crossing.of_border = edge.has_box() && *nearest < reach;
    const Side side = static_cast<Side>(nearest - left_over.begin());
    crossing.upright = side == Side::left || side == Side::right;
    const double x = std::clamp(edge.left + edge.width / 2.0 - view_.left, 0.0, view_.width);
    const double y = std::clamp(double(edge.top) + edge.height - view_.top, 0.0, view_.height);
    switch (side) {
      case Side::top:
        crossing.location = x;
        break;
      case Side::right:
        crossing.location = view_.width + y;
        break;
      case Side::bottom:
        crossing.location = view_.width + view_.height + (view_.width - x);
        break;
      case Side::left:
        crossing.location = 2 * view_.width + view_.height + (view_.height - y);
        break;
    }
    return crossing;
  }

 private:
  double time_of(const TrackRow& row) const { return seconds(log_.time_of(row.frame)); }

  /// px/s
  Vector<2> velocity(const Tracklet& rows, bool tail) const {
    const TrackRow& edge = tail ? rows.back() : rows.front();
    const TrackRow* other = &edge;
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const TrackRow& row = tail ? rows[rows.size() - 1 - k] : rows[k];
      other = &row;
      if (std::abs(time_of(row) - time_of(edge)) >= kMotionFor) break;
    }
    const double lasted = time_of(edge) - time_of(*other);
    if (std::abs(lasted) < 0.1) return Vector<2>::Zero();
    return Vector<2>(edge.x - other->x, edge.y - other->y) / lasted;
  }

  const TrackletLog& log_;
  Box view_;
  double begin_, end_;
};

image::Worn worn_of(const Tracklet& rows, const TrackletLog& log) {
  std::vector<image::Clothes> all, first, last;
  image::Worn worn;
  worn.begin = seconds(log.time_of(rows.front().frame));
  worn.end = seconds(log.time_of(rows.back().frame));
  for (const TrackRow& row : rows) {
    const image::Clothes clothes = row.clothes.unpacked();
    if (!row.observed() || row.ambiguous || !(clothes.upper || clothes.lower || clothes.shanks)) continue;
    const double time = seconds(log.time_of(row.frame));
    all.push_back(clothes);
    if (time - worn.begin <= kClothesFor) first.push_back(clothes);
    if (worn.end - time <= kClothesFor) last.push_back(clothes);
  }
  worn.first = image::mean_clothes(first);
  worn.last = image::mean_clothes(last);
  worn.whole = image::mean_clothes(all);
  if (static_cast<int>(all.size()) >= kMinTimeSteps) {
    const std::span<const image::Clothes> detected = all;
    worn.early = image::mean_clothes(detected.first(detected.size() / 3));
    worn.late = image::mean_clothes(detected.last(detected.size() / 3));
  }
  return worn;
}

class Returns {
 public:
  Returns(std::span<const Tracklet> tracklets, const TrackletLog& log, const Box& view, const ReturnOptions& options)
      : options_(options), view_(view) {
    if (tracklets.empty()) return;
    std::vector<image::Worn> worn;
    for (const Tracklet& rows : tracklets) worn.push_back(worn_of(rows, log));
    begin_ = end_ = worn.front().begin;
    for (const image::Worn& one : worn) begin_ = std::min(begin_, one.begin), end_ = std::max(end_, one.end);
    const Crossings crossings(log, view, begin_, end_);
    for (const Tracklet& rows : tracklets) {
      heads_.push_back(crossings.of(rows, false));
      tails_.push_back(crossings.of(rows, true));
    }
    find_pairs(image::Wardrobe(worn));
  }

  std::vector<Returned> find() {
    std::vector<Returned> found;
    if (pairs_.empty()) return found;
    learn_from(known_by_clothes());
    const int count = static_cast<int>(heads_.size());
    const std::vector<assign::GatedPair> weighed = weighed_pairs();
    const std::vector<double> beliefs = assign::association_beliefs(count, count, weighed);
    const std::vector<int> next = assign::best_successors(count, weighed);
    for (std::size_t k = 0; k < weighed.size(); ++k) {
      const assign::GatedPair& pair = weighed[k];
      if (next[static_cast<std::size_t>(pair.row)] != pair.column || beliefs[k] < options_.min_probability) continue;
      if (comings() < kMinComings && clothes_[k] < kClothesAlone) continue;
      found.push_back({pair.row, pair.column, head(pair).time - tail(pair).time, beliefs[k]});
    }
    return found;
  }

 private:
  const Crossing& head(const assign::GatedPair& pair) const { return heads_[static_cast<std::size_t>(pair.column)]; }
  const Crossing& tail(const assign::GatedPair& pair) const { return tails_[static_cast<std::size_t>(pair.row)]; }

  /// Of the pairs, whether they are one person's by clothes and the time away alone, at first rates by which all who come in are
  /// new: evidence without the border and without learned rates.
  std::vector<bool> known_by_clothes() const {
    const int count = static_cast<int>(heads_.size());
    const double rate = static_cast<double>(comings()) / std::max(1.0, end_ - begin_);
    std::vector<assign::GatedPair> weighed = pairs_;
    for (assign::GatedPair& pair : weighed) pair.gain += std::log(kFirstFraction / rate);
    std::vector<bool> known;
    for (const double belief : assign::association_beliefs(count, count, weighed)) known.push_back(belief >= kKnown);
    return known;
  }

  void learn_from(const std::vector<bool>& known) {
    const auto came = static_cast<double>(comings()), returned = static_cast<double>(std::count(known.begin(), known.end(), true));
    double could = kFirstCounts;
    for (const Crossing& out : tails_) could += out.of_border && !out.of_recording ? come_back_by_end(out) : 0;
    fraction_ = std::clamp((returned + kFirstCounts * kFirstFraction) / could, 0.02, 0.95);
    newcomers_ = std::max(0.5, came - returned) / std::max(1.0, end_ - begin_);
    double maximum = -std::numeric_limits<double>::infinity();
    for (const double spread : kSpreads) {
      double likelihood = -0.5 * std::pow(std::log(spread) / kSpreadUnsure, 2);
      for (std::size_t k = 0; k < known.size(); ++k)
        likelihood += known[k] ? log_position(tail(pairs_[k]), head(pairs_[k]), spread) : 0;
      if (likelihood > maximum) maximum = likelihood, spread_ = spread;
    }
  }

  /// Pairs that may be, with what clothes, place and time say but for how often people come and come back.
  void find_pairs(const image::Wardrobe& wardrobe) {
    assign::for_each_successor(tails_, heads_, options_.longest_away, [&](int row, int column) {
      const Crossing &out = tails_[static_cast<std::size_t>(row)], &in = heads_[static_cast<std::size_t>(column)];
      const double away = in.time - out.time;
      if (!out.of_border || !in.of_border || out.of_recording || in.of_recording || away < options_.shortest_away) return;
      const double size = std::sqrt(out.size * in.size), distance = distance_along(out.location, in.location, view_);
      if (distance > (1 + kFastest * away) * size || std::abs(std::log(in.size / out.size)) > kMaxGrown) return;
      const std::optional<double> clothes = wardrobe.log_ratio(row, column);
      if (!clothes) return;
      pairs_.push_back({row, column, *clothes + log_time(away)});
      clothes_.push_back(*clothes);
    });
  }

  double log_position(const Crossing& out, const Crossing& in, double spread) const {
    const double size = std::sqrt(out.size * in.size) * spread, pace = in.upright ? options_.along : options_.across;
    const double deviation = size * (kPositionUnsure + pace * (in.time - out.time));
    const double distance = distance_along(out.location, in.location, view_) / deviation;
    const double near = std::exp(-0.5 * distance * distance) / (std::sqrt(2 * std::numbers::pi) * deviation);
    return std::log((1 - options_.anywhere) * near + options_.anywhere / perimeter(view_)) - std::log(density_of_newcomers(in));
  }

  /// Per px of the border, by where others came in.
  double density_of_newcomers(const Crossing& in) const {
    double sum = kAnywhereCounts / perimeter(view_), count = kAnywhereCounts;
    for (const Crossing& other : heads_) {
      if (&other == &in || !other.of_border || other.of_recording) continue;
      const double deviation = kBandwidth * in.size, distance = distance_along(other.location, in.location, view_) / deviation;
      sum += std::exp(-0.5 * distance * distance) / (std::sqrt(2 * std::numbers::pi) * deviation);
      count += 1;
    }
    return sum / count;
  }

  /// 1/s: as likely at any time up to `typically_away`, from then on less and less.
  double log_time(double away) const {
    const double fading = kFading * options_.typically_away;
    return -std::max(0.0, away - options_.typically_away) / fading - std::log(options_.typically_away + fading);
  }

  std::vector<assign::GatedPair> weighed_pairs() const {
    std::vector<assign::GatedPair> weighed = pairs_;
    for (assign::GatedPair& pair : weighed)
      pair.gain += log_position(tail(pair), head(pair), spread_) + std::log(fraction_ / newcomers_) -
                   std::log1p(-fraction_ * come_back_by_end(tail(pair)));
    return weighed;
  }

  /// Of those who come back at all, who do before the recording ends.
  double come_back_by_end(const Crossing& out) const {
    const double usually = options_.typically_away, fading = kFading * usually,
                 left = std::min(options_.longest_away, end_ - out.time);
    return (std::min(left, usually) + fading * (1 - std::exp(-std::max(0.0, left - usually) / fading))) / (usually + fading);
  }

  std::ptrdiff_t comings() const {
    return std::count_if(heads_.begin(), heads_.end(), [](const Crossing& in) { return in.of_border && !in.of_recording; });
  }

  ReturnOptions options_;
  Box view_;
  double begin_ = 0, end_ = 0;            // s, of the recording
  std::vector<Crossing> heads_, tails_;   // of the tracklets
  std::vector<assign::GatedPair> pairs_;  // tails and heads
  std::vector<double> clothes_;           // of each pair: log-likelihood ratio of the clothes
  double fraction_ = kFirstFraction;      // of those who leave, who come back
  double newcomers_ = 0;                  // 1/s
  double spread_ = 1;
};

}  // namespace

std::vector<Returned> find_returned(std::span<const Tracklet> tracklets, const TrackletLog& log, const Box& view,
                                    const ReturnOptions& options) {
  return Returns(tracklets, log, view, options).find();
}

void join_returned(std::vector<Tracklet>& tracklets, std::span<const Returned> returned) {
  std::vector<int> next(tracklets.size(), assign::kNoIndex);
  for (const Returned& pair : returned) next[static_cast<std::size_t>(pair.before)] = pair.after;
  std::vector<Tracklet> joined;
  for (const std::vector<int>& chain : assign::chains_of(next)) {
    Tracklet& whole = joined.emplace_back(std::move(tracklets[static_cast<std::size_t>(chain.front())]));
    for (const int piece : std::span(chain).subspan(1)) {
      const Tracklet& rows = tracklets[static_cast<std::size_t>(piece)];
      whole.insert(whole.end(), rows.begin(), rows.end());
    }
  }
  tracklets = std::move(joined);
}

}  // namespace marey::track::offline

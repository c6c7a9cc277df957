// Tracklets are joined where one ends and another begins as one walking target would: the mean velocity over the gap fits the
// velocities before and after it, and the size is the same. Every end and every beginning takes part in one assignment over the
// whole recording that maximises the sum of log-likelihood ratios; first over short gaps, then, with the longer and surer
// tracklets that gives, over long ones.
// Cost: near linear in tracklets, by the number that begin while a gap may last; the rows are passed over a few times.
#include "marey/track/join.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "marey/assign/gated_assignment.h"
#include "marey/track/smooth.h"

namespace marey::track {
namespace {

using Tracklet = TrackletLog::Tracklet;

/// One end of a tracklet: a straight line through its last, or first, observations.
struct End {
  double time = 0;  // s
  Vector<2> position = Vector<2>::Zero();
  Vector<2> velocity = Vector<2>::Zero();
  double speed_variance = 0;  // per axis, (sizes/s)²
  double size = 1;            // height, or 1
  double log_width = 0;
};

constexpr double fit_span = 0.8;        // s of a tracklet that its end is fitted to
constexpr double prior_speed = 0.6;     // sizes/s; what is known before two observations are
constexpr double worth_of_joining = 9;  // how many log-likelihoods a newcomer at just this place and time is behind
constexpr double gate = 16;             // chi-square, place and size: 4 degrees of freedom

constexpr double weak_lasting = 1.5;  // s that weak observations must last to be believed
constexpr double weak_share = 0.6;    // and of the frames, the share they must be in

class Joiner {
 public:
  Joiner(const TrackletLog& log, const JoinOptions& options) : log_(log), options_(options) {}

  void join(std::vector<Tracklet>& tracklets, double longest_gap) {
    std::vector<End> heads;
    std::vector<End> tails;
    for (const Tracklet& tracklet : tracklets) {
      heads.push_back(end_of(tracklet, false));
      tails.push_back(end_of(tracklet, true));
    }
    const auto successors =
        assigner_.assign(static_cast<int>(tails.size()), static_cast<int>(heads.size()), candidates(tails, heads, longest_gap));
    merge(tracklets, successors);
  }

 private:
  double time_of(const TrackRow& row) const { return seconds(log_.time_of(row.frame)); }

  /// A regularised line through the observed rows of the last, or first, `fit_span` seconds.
  End end_of(const Tracklet& rows, bool tail) const {
    const TrackRow& edge = tail ? rows.back() : rows.front();
    End end;
    end.time = time_of(edge);
    double n = 0, t1 = 0, t2 = 0, size = 0, width = 0;
    Vector<2> x1 = Vector<2>::Zero();
    Vector<2> xt = Vector<2>::Zero();
    for (std::size_t k = 0; k < rows.size(); ++k) {
      const TrackRow& row = tail ? rows[rows.size() - 1 - k] : rows[k];
      const double t = time_of(row) - end.time;
      if (std::abs(t) > fit_span) break;
      if (!row.observed()) continue;
      const Vector<2> x(row.x, row.y);
      n += 1;
      t1 += t;
      t2 += t * t;
      x1 += x;
      xt += t * x;
      size += row.has_box() ? row.height : 1;
      width += row.has_box() ? std::log(row.width) : 0;
    }
    end.size = size / n;
    end.log_width = width / n;
    const double spread = t2 - t1 * t1 / n;
    const double noise = options_.place_noise * options_.place_noise / 2;
    const double regular = noise / (prior_speed * prior_speed);  // as if the target had been at rest, that surely
    end.velocity = (xt - t1 * x1 / n) / (spread + regular);
    end.speed_variance = noise / (spread + regular);
    end.position = x1 / n - end.velocity * (t1 / n);
    return end;
  }

  std::vector<assign::GatedPair> candidates(const std::vector<End>& tails, const std::vector<End>& heads,
                                            double longest_gap) const {
    std::vector<int> by_time(heads.size());
    std::iota(by_time.begin(), by_time.end(), 0);
    std::sort(by_time.begin(), by_time.end(),
              [&](int a, int b) { return std::pair(heads[a].time, a) < std::pair(heads[b].time, b); });
    std::vector<assign::GatedPair> pairs;
    for (int tail = 0; tail < static_cast<int>(tails.size()); ++tail) {
      const auto later = [&](double time, int head) { return time < heads[head].time; };
      auto next = std::upper_bound(by_time.begin(), by_time.end(), tails[tail].time, later);
      for (; next != by_time.end() && heads[*next].time - tails[tail].time <= longest_gap; ++next) {
        const double worth = gain(tails[tail], heads[*next]);
        if (worth > 0) pairs.push_back({tail, *next, worth});
      }
    }
    return pairs;
  }

  /// Logarithm of how much likelier it is that one target made both ends than that one left and another came.
  double gain(const End& tail, const End& head) const {
    const double gap = head.time - tail.time;
    const double size = std::sqrt(tail.size * head.size);
    const double weight_sum = 1 / tail.speed_variance + 1 / head.speed_variance;
    const Vector<2> velocity = (tail.velocity / tail.speed_variance + head.velocity / head.speed_variance) / weight_sum;
    const Vector<2> residual = (head.position - tail.position - gap * velocity) / size;
    const double strayed = options_.speed_noise * gap;
    const double variance = options_.place_noise * options_.place_noise + strayed * strayed / 2 + gap * gap / weight_sum;
    const double turned = (head.velocity - tail.velocity).squaredNorm() / (size * size) /
                          (tail.speed_variance + head.speed_variance + 2 * options_.speed_noise * options_.speed_noise);
    const double grown = (std::log(head.size / tail.size)) / options_.size_noise;
    const double widened = (head.log_width - tail.log_width) / (2 * options_.size_noise);
    const double distance = residual.squaredNorm() / variance + grown * grown + widened * widened;
    if (distance > gate) return 0;
    const double scale = options_.place_noise * options_.place_noise;
    return (worth_of_joining - distance - turned / 2 - std::log(variance / scale) - gap / 2) / 2;
  }

  static void merge(std::vector<Tracklet>& tracklets, std::span<const int> successors) {
    std::vector<char> follows(tracklets.size(), 0);
    for (const int successor : successors) {
      if (successor != assign::kNoIndex) follows[successor] = 1;
    }
    std::vector<Tracklet> joined;
    for (std::size_t first = 0; first < tracklets.size(); ++first) {
      if (follows[first]) continue;
      Tracklet whole = std::move(tracklets[first]);
      for (int next = successors[first]; next != assign::kNoIndex; next = successors[next]) {
        whole.insert(whole.end(), tracklets[next].begin(), tracklets[next].end());
        Tracklet().swap(tracklets[next]);
      }
      joined.push_back(std::move(whole));
    }
    tracklets = std::move(joined);
  }

  const TrackletLog& log_;
  const JoinOptions& options_;
  assign::GatedAssigner assigner_;
};

/// Predicted rows at the ends are cut.
void trim(Tracklet& rows) {
  while (!rows.empty() && !rows.back().observed()) rows.pop_back();
  const auto first = std::find_if(rows.begin(), rows.end(), [](const TrackRow& row) { return row.observed(); });
  rows.erase(rows.begin(), first);
}

/// What the observations of one target say of it.
struct Standing {
  std::int64_t seen = 0;
  double lasted = 0;  // s
  double share = 0;   // of its frames in which it was seen
  double score = 0;   // mean
};

Standing standing_of(const Tracklet& rows, const TrackletLog& log) {
  Standing standing;
  for (const TrackRow& row : rows) {
    if (!row.observed()) continue;
    ++standing.seen;
    standing.score += row.score;
  }
  standing.score /= static_cast<double>(std::max<std::int64_t>(1, standing.seen));
  standing.lasted = seconds(log.time_of(rows.back().frame) - log.time_of(rows.front().frame));
  standing.share = static_cast<double>(standing.seen) / (rows.back().frame - rows.front().frame + 1);
  return standing;
}

/// The score that half of the observations reach.
double usual_score(std::span<const Tracklet> tracklets) {
  std::vector<float> scores;
  for (const Tracklet& tracklet : tracklets) {
    for (const TrackRow& row : tracklet) {
      if (row.observed()) scores.push_back(row.score);
    }
  }
  if (scores.empty()) return 1;
  const auto middle = scores.begin() + static_cast<std::ptrdiff_t>(scores.size() / 2);
  std::nth_element(scores.begin(), middle, scores.end());
  return *middle;
}

/// Too short, seen too rarely, or both rather short or rarely seen and unusually weak.
bool is_false_alarm(const Standing& standing, double usual, const JoinOptions& options) {
  if (standing.seen < options.fewest || standing.lasted < options.shortest || standing.share < options.rarest) return true;
  const bool weak = standing.score < usual - options.weaker;
  return weak && (standing.lasted < weak_lasting || standing.share < weak_share);
}

std::vector<TrackRow> by_frame(std::vector<Tracklet>& tracklets) {
  std::sort(tracklets.begin(), tracklets.end(), [](const Tracklet& a, const Tracklet& b) {
    return std::pair(a.front().frame, a.front().id) < std::pair(b.front().frame, b.front().id);
  });
  std::size_t total = 0;
  for (const Tracklet& tracklet : tracklets) total += tracklet.size();
  std::vector<TrackRow> rows;
  rows.reserve(total);
  std::int32_t id = 0;
  for (Tracklet& tracklet : tracklets) {
    ++id;
    for (TrackRow& row : tracklet) {
      row.id = id;
      rows.push_back(row);
    }
    Tracklet().swap(tracklet);
  }
  std::sort(rows.begin(), rows.end(),
            [](const TrackRow& a, const TrackRow& b) { return a.frame != b.frame ? a.frame < b.frame : a.id < b.id; });
  return rows;
}

}  // namespace

std::vector<TrackRow> join(TrackletLog& log, const JoinOptions& options) {
  std::vector<Tracklet> tracklets = log.take_tracklets();
  for (Tracklet& tracklet : tracklets) trim(tracklet);
  std::erase_if(tracklets, [](const Tracklet& tracklet) { return tracklet.empty(); });
  Joiner joiner(log, options);
  joiner.join(tracklets, std::min(1.0, options.longest_gap));
  joiner.join(tracklets, options.longest_gap);
  const double usual = usual_score(tracklets);
  std::erase_if(tracklets, [&](const Tracklet& rows) { return is_false_alarm(standing_of(rows, log), usual, options); });
  for (Tracklet& tracklet : tracklets) {
    fill_gaps(tracklet, log, options.longest_filled);
    smooth(tracklet, log, {.place = options.smoothing, .size = options.size_smoothing});
  }
  return by_frame(tracklets);
}

}  // namespace marey::track

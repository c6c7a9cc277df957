#include "marey/track/ground/offline/ground_join.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <tuple>
#include <utility>

#include <Eigen/Cholesky>

#include "marey/assign/association_beliefs.h"
#include "marey/assign/successors.h"
#include "marey/core/colour.h"
#include "marey/geometry/median.h"
#include "marey/track/ground/offline/entry_exit_map.h"

namespace marey::track::ground::offline {
namespace {

constexpr double end_span = 3;  // s of a tracklet that its end is evaluated by

constexpr double tracker_knows = 2;  // what the tracker thought of a piece that was cut off, as a logarithm of likelihoods
constexpr double stands = 0.1;       // gain, at least, of continuing as the tracker said: less than any other claim; unswept
constexpr double unambiguously_others = -4;  // of colours: the tracker went over to another person; unswept
constexpr double clothes_vary = 5;  // as perceived, one person's colour from one segment to another: sun, shade, another camera
constexpr double thinned = 0.6;     // deviation as perceived, of one in L*a*b*
constexpr double surest_apart = -9, surest_same = 3;  // however colours differ or agree, they may be another person's
constexpr std::size_t kMaxKinds = 300;

constexpr int kIterations = 5;   // of learning who left, and where people leave
constexpr double kMinOdds = -6;  // logarithm of odds: pairs that are less likely to begin with are omitted
constexpr double kBounds = 1.5;  // s

template <int N>
double log_normal(const Vector<N>& residual, const Matrix<N>& S) {
  const Eigen::LLT<Matrix<N>> llt(S);
  const Matrix<N> L = llt.matrixL();
  const Vector<N> white = llt.matrixL().solve(residual);
  return -0.5 * white.squaredNorm() - L.diagonal().array().log().sum() - 0.5 * N * std::log(2 * std::numbers::pi);
}

double square(double x) {
  return x * x;
}

/// Of the difference of two colours, as perceived.
double colour_log_normal(const Appearance& a, const Appearance& b) {
  const double measured = thinned * thinned * (square(a.deviation) + square(b.deviation));
  const double variance = measured + 2 * clothes_vary * clothes_vary;
  return -0.5 * ((perceived(a) - perceived(b)).squaredNorm() / variance + 3 * std::log(2 * std::numbers::pi * variance));
}

/// Whether a person there may be about to be out of sight: some place within a second's walk is.
bool near_border(const GroundState& state, Timestamp time, double direction, const InSight& in_sight) {
  if (!in_sight) return false;
  const Vector<2> ahead = state.location() + direction * 0.7 * state.velocity();
  for (int k = 0; k < 8; ++k) {
    const double angle = k * std::numbers::pi / 4;
    if (!in_sight(ahead + 1.5 * Vector<2>(std::cos(angle), std::sin(angle)), time)) return true;
  }
  return false;
}

/// Pairs within the longest gap that gain more than `least`.
std::vector<assign::GatedPair> gated_pairs(std::span<const GroundEnd> tails, std::span<const GroundEnd> heads,
                                           const GroundColours& colours, const GroundChainOptions& options, double minimum) {
  return assign::successor_pairs(
      tails, heads, duration_from_seconds(options.longest_gap),
      [&](int tail, int head) { return gain_of_joining(tails[tail], heads[head], colours, options); }, minimum);
}

class Chainer {
 public:
  Chainer(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, const InSight& in_sight,
          const GroundChainOptions& options)
      : tracklets_(tracklets), times_(times), options_(options) {
    std::tie(heads_, tails_) = ends_of(tracklets, times, options.motion);
    for (const GroundEnd& head : heads_) head_at_border_.push_back(near_border(head.state, head.time, -1, in_sight));
    for (const GroundEnd& tail : tails_) tail_at_border_.push_back(near_border(tail.state, tail.time, 1, in_sight));
    learn_openness();
  }

  std::vector<GroundChain> chains() {
    std::vector<std::vector<int>> chains(tracklets_.size());
    for (std::size_t i = 0; i < chains.size(); ++i) chains[i] = {static_cast<int>(i)};
    for (const double fraction : {0.05, 0.25, 1.0}) lengthen(chains, fraction * options_.longest_gap);
    std::sort(chains.begin(), chains.end(), [&](const std::vector<int>& a, const std::vector<int>& b) {
      return std::pair(heads_[a.front()].time, a.front()) < std::pair(heads_[b.front()].time, b.front());
    });
    std::vector<GroundChain> result;
    for (std::vector<int>& members : chains) {
      GroundChain& one = result.emplace_back(GroundChain{std::move(members), {}});
      for (std::size_t i = 1; i < one.members.size(); ++i)
        one.probabilities.push_back(probability(one.members[i - 1], one.members[i]));
    }
    return result;
  }

 private:
  /// By turns: how likely each end and beginning are one person's, and where people come and leave.
  void learn_openness() {
    const std::size_t n = tracklets_.size();
    if (n == 0) return;
    const double recorded = std::max(1.0, seconds(times_.back() - times_.front()));
    const double bounds = std::min(kBounds, recorded / 4);  // at the recording's own bounds tracks begin and end of themselves
    std::vector<std::size_t> begun, ended;
    for (std::size_t i = 0; i < n; ++i) {
      if (seconds(heads_[i].time - times_.front()) > bounds) begun.push_back(i);
      if (seconds(times_.back() - tails_[i].time) > bounds) ended.push_back(i);
    }
    std::vector<double> came(n, 0.5), left(n, 0.5);
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      std::vector<EntryExitMap::EntryExit> comings, leavings;
      for (const std::size_t i : begun) comings.push_back({heads_[i].state.location(), head_at_border_[i] != 0, came[i]});
      for (const std::size_t i : ended) leavings.push_back({tails_[i].state.location(), tail_at_border_[i] != 0, left[i]});
      const EntryExitMap openness(comings, leavings, recorded);
      for (std::size_t k = 0; k < begun.size(); ++k) heads_[begun[k]].coming = openness.coming(comings[k]);
      for (std::size_t k = 0; k < ended.size(); ++k) tails_[ended[k]].leaving = openness.leaving(leavings[k]);
      weigh_pairs(came, left);
    }
  }

  /// Pairs with what does not depend on where people come and leave, found once.
  void find_pairs() {
    std::vector<GroundColours::Detected> detected;
    for (std::size_t i = 0; i < tracklets_.size(); ++i) {
      heads_[i].appearance = tails_[i].appearance = appearance_of(tracklets_[i].samples);
      if (heads_[i].appearance) detected.push_back({*heads_[i].appearance, seconds(tails_[i].time - heads_[i].time)});
    }
    pairs_ = gated_pairs(tails_, heads_, GroundColours(detected, options_.teams), options_, kMinOdds);
    for (assign::GatedPair& pair : pairs_) pair.gain -= openness_gain(pair);
  }

  double openness_gain(const assign::GatedPair& pair) const {
    const double leaving = tails_[static_cast<std::size_t>(pair.row)].leaving;
    return std::log((1 - leaving) / leaving) - std::log(heads_[static_cast<std::size_t>(pair.column)].coming);
  }

  /// Marginal probabilities of all pairs, each end with one beginning at most and vice versa.
  void weigh_pairs(std::vector<double>& came, std::vector<double>& left) {
    if (pairs_.empty()) find_pairs();
    std::vector<assign::GatedPair> weighed = pairs_;
    for (assign::GatedPair& pair : weighed) pair.gain += openness_gain(pair);
    const std::vector<double> probabilities =
        assign::association_beliefs(static_cast<int>(tails_.size()), static_cast<int>(heads_.size()), weighed);
    came.assign(heads_.size(), 1);
    left.assign(tails_.size(), 1);
    probabilities_.clear();
    for (std::size_t k = 0; k < probabilities.size(); ++k) {
      const double probability = probabilities[k];
      probabilities_[{pairs_[k].row, pairs_[k].column}] = probability;
      came[column(k)] -= probability;
      left[row(k)] -= probability;
    }
    for (double& value : came) value = std::clamp(value, 0.0, 1.0);
    for (double& value : left) value = std::clamp(value, 0.0, 1.0);
  }

  std::size_t row(std::size_t pair) const { return static_cast<std::size_t>(pairs_[pair].row); }
  std::size_t column(std::size_t pair) const { return static_cast<std::size_t>(pairs_[pair].column); }

  double probability(int tail, int head) const {
    const auto found = probabilities_.find({tail, head});
    return found == probabilities_.end() ? 0 : found->second;
  }

  /// Joins chains over gaps of at most `longest`.
  void lengthen(std::vector<std::vector<int>>& chains, double longest) {
    std::vector<GroundEnd> heads, tails;
    std::vector<GroundColours::Detected> detected;
    for (const std::vector<int>& members : chains) {
      heads.push_back(heads_[members.front()]);
      tails.push_back(tails_[members.back()]);
      std::vector<GroundSample> all;
      for (const int member : members) {
        const std::vector<GroundSample>& samples = tracklets_[member].samples;
        all.insert(all.end(), samples.begin(), samples.end());
      }
      heads.back().appearance = tails.back().appearance = appearance_of(all);
      if (!heads.back().appearance) continue;
      detected.push_back({*heads.back().appearance, seconds(tails.back().time - heads.back().time)});
    }
    GroundChainOptions options = options_;
    options.longest_gap = longest;
    merge(chains, best_links(tails, heads, GroundColours(detected, options_.teams), options));
  }

  static void merge(std::vector<std::vector<int>>& chains, std::span<const int> next) {
    std::vector<std::vector<int>> joined;
    for (const std::vector<int>& parts : assign::chains_of(next)) {
      std::vector<int>& whole = joined.emplace_back();
      for (const int part : parts) whole.insert(whole.end(), chains[part].begin(), chains[part].end());
    }
    chains = std::move(joined);
  }

  std::span<const GroundTracklet> tracklets_;
  std::span<const Timestamp> times_;
  const GroundChainOptions& options_;
  std::vector<GroundEnd> heads_, tails_;
  std::vector<char> head_at_border_, tail_at_border_;
  std::vector<assign::GatedPair> pairs_;  // tails and heads; gains without what openness adds
  std::map<std::pair<int, int>, double> probabilities_;
};

}  // namespace

GroundColours::GroundColours(std::span<const Detected> detected, const std::optional<GroundTeams>& teams)
    : kinds_(detected.begin(), detected.end()), teams_(teams) {
  std::stable_sort(kinds_.begin(), kinds_.end(), [](const Detected& a, const Detected& b) { return a.seconds > b.seconds; });
  if (kinds_.size() > kMaxKinds) kinds_.resize(kMaxKinds);
}

double GroundColours::same(const std::optional<Appearance>& a, const std::optional<Appearance>& b) const {
  if (!a || !b || kinds_.empty()) return 0;
  double common = 0;
  double all = 0;
  for (const Detected& kind : kinds_) {
    common += (kind.seconds + 0.1) * std::exp(colour_log_normal(kind.clothing, *b));
    all += kind.seconds + 0.1;
  }
  const double newcomer = std::log(std::max(common / all, 1e-12));  // of some colour that was not seen yet
  const double team = teams_ ? teams_->same_for_long(*a, *b) : 0;
  return std::clamp(colour_log_normal(*a, *b) - newcomer + team, surest_apart, surest_same);
}

std::pair<std::vector<GroundEnd>, std::vector<GroundEnd>> ends_of(std::span<const GroundTracklet> tracklets,
                                                                  std::span<const Timestamp> times, const GroundMotion& motion) {
  std::vector<GroundEnd> heads, tails;
  for (const GroundTracklet& tracklet : tracklets) {
    GroundEnd head, tail;
    head.piece = tail.piece = static_cast<int>(heads.size());
    tail.goes_on = tracklet.goes_on;
    const std::vector<GroundSample>& samples = tracklet.samples;
    head.time = times[static_cast<std::size_t>(samples.front().instant)];
    tail.time = times[static_cast<std::size_t>(samples.back().instant)];
    head.state = first_state(samples, times, motion, end_span);
    tail.state = last_state(samples, times, motion, end_span);
    heads.push_back(head);
    tails.push_back(tail);
  }
  return {std::move(heads), std::move(tails)};
}

double log_continuity(const GroundEnd& tail, const GroundEnd& head, const GroundColours& colours, const GroundMotion& motion,
                      const EndpointError& stray) {
  const GroundState expected = predicted(tail.state, seconds(head.time - tail.time), motion);
  Vector<4> residual;
  residual << head.state.location() - expected.location(), head.state.velocity() - expected.velocity();
  Matrix<4> S = expected.covariance() + head.state.covariance();
  S.diagonal().head<2>().array() += 2 * square(stray.location);
  S.diagonal().tail<2>().array() += 2 * square(stray.speed);
  return log_normal<4>(residual, S) + colours.same(tail.appearance, head.appearance);
}

std::optional<double> gain_of_joining(const GroundEnd& tail, const GroundEnd& head, const GroundColours& colours,
                                      const GroundChainOptions& options) {
  const double gap = seconds(head.time - tail.time);
  if (gap <= 0 || gap > options.longest_gap) return std::nullopt;
  const double distance = (head.state.location() - tail.state.location()).norm();
  const double unsure = 3 * std::sqrt(tail.state.P[0].trace() + head.state.P[0].trace() + 2 * square(EndpointError{}.location));
  if (distance > options.max_speed * gap + unsure) return std::nullopt;
  const Matrix<2> anyhow = head.state.P[3] + speed_variance(options.motion) * Matrix<2>::Identity();
  const double found_again = std::log((1 - tail.leaving) / tail.leaving) - 2 * std::log1p(gap);
  const double came = std::log(head.coming) + log_normal<2>(head.state.velocity(), anyhow);
  const bool as_tracked = tail.goes_on && head.piece == tail.piece + 1;
  const double gain = log_continuity(tail, head, colours, options.motion) + found_again - came + (as_tracked ? tracker_knows : 0);
  // What the tracker said stands where no other person wants either piece, unless they are plainly two people's.
  if (as_tracked && colours.same(tail.appearance, head.appearance) > unambiguously_others) return std::max(gain, stands);
  return gain;
}

std::vector<int> best_links(std::span<const GroundEnd> tails, std::span<const GroundEnd> heads, const GroundColours& colours,
                            const GroundChainOptions& options) {
  return assign::best_successors(static_cast<int>(tails.size()), gated_pairs(tails, heads, colours, options, 0));
}

std::vector<GroundChain> chain(std::span<const GroundTracklet> tracklets, std::span<const Timestamp> times, const InSight& in_sight,
                               const GroundChainOptions& options) {
  return Chainer(tracklets, times, in_sight, options).chains();
}

std::optional<Appearance> appearance_of(std::span<const GroundSample> samples) {
  std::array<std::vector<float>, 3> values;
  double variance = 0;
  for (const GroundSample& sample : samples) {
    if (!sample.has_colour()) continue;
    for (int i = 0; i < 3; ++i) values[i].push_back(static_cast<float>(sample.lab()[i]));
    variance += static_cast<double>(sample.colour_deviation) * sample.colour_deviation;
  }
  const std::size_t n = values[0].size();
  if (n == 0) return std::nullopt;
  constexpr double alike = 8;  // neighbouring samples err alike: this many count as one
  const double count = static_cast<double>(n);
  return Appearance{.lightness = geometry::median(values[0]),
                    .a = geometry::median(values[1]),
                    .b = geometry::median(values[2]),
                    .deviation = static_cast<float>(std::sqrt(variance / count / std::max(1.0, count / alike)))};
}

}  // namespace marey::track::ground::offline

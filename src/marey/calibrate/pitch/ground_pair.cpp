#include "marey/calibrate/pitch/ground_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <span>
#include <tuple>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace marey::calibrate::pitch {
namespace {

constexpr double kSegment_s = 2;                    // long enough to show how a person moves, short enough to be one person's
constexpr double kStride_s = 1;                     // from one segment to the next: they overlap,
constexpr double kWeight = kStride_s / kSegment_s;  // by definition: and count the less
constexpr double kSample_s = 0.2;                   // between the places that are compared
constexpr int kSegmentSamples = 10;                 // of a segment,
constexpr std::size_t kMinSegmentSamples = 5;       // where one of both was not seen throughout
constexpr double kMemory_s = 0.5;                   // errors hang together for about this long
constexpr double kFloor_m = 0.05;                   // noise that a smoothed place has at least
constexpr double kDifferent_m = 1.0;                // how much the distance of two different people changes within a segment
constexpr double kDensity = 0.01;                   // other people per m²
constexpr double kMaxDistance_m = 4;                // who is farther apart is not one person
constexpr double kPaired = 2;                       // nats above which a pair takes part in the fine search
constexpr double kBlock_s = 6;                      // the systematic part of a pair is taken to stay for this long
constexpr double kStep_s = 0.15;                    // of the coarse search
constexpr std::size_t kPeaks = 4;                   // that are refined
constexpr int kIterations = 10;                     // of the fine search
constexpr double kStandsOut = 4;                    // times what peaks differ by chance
constexpr double kExplained = 0.2;                  // of who walks before both cameras, that must be seen by both
constexpr double kOptimism = 1.5;   // by which errors that hang together for longer make the answer worse than least squares say
constexpr double kMinFree = 20;     // degrees of freedom that estimate the noise
constexpr double kMinNoise = 0.02;  // and by how much less, or more, than covariances say
constexpr int kNoiseRounds = 2;
constexpr double kSamePeak_s = 0.5;  // a peak so near is the same one
constexpr double kWalks_m = 1;       // who gets no farther within a segment stands
constexpr double kMinMoving_s = 4;   // person-seconds of walking in the ground both see, that decide anything
constexpr double kMinOverlap_s = 3;  // person-seconds in places that both see, that make an overlap
constexpr double kCell_m = 4;
constexpr double kTick_s = SmoothPath::kStep_s;
constexpr std::size_t kMaxSegments = 600;

double log_det(const Matrix<2>& m) {
  return std::log(m.determinant());
}

std::pair<int, int> cell_of(const Vector<2>& location) {
  return {static_cast<int>(std::floor(location.x() / kCell_m)), static_cast<int>(std::floor(location.y() / kCell_m))};
}

std::pair<double, double> span_of(const std::vector<SmoothPath>& paths) {
  double begin = 1e300, end = -1e300;
  for (const SmoothPath& path : paths) begin = std::min(begin, path.begin_s()), end = std::max(end, path.end_s());
  return {begin, end};
}

/// Normal equations of the shift and the systematic part of all pairs; each pair's own systematic part is a block of its own.
struct ShiftEquations {
  struct Block {
    Matrix<2> own;
    Eigen::Matrix<double, 2, 3> shared = Eigen::Matrix<double, 2, 3>::Zero();
    Vector<2> right = Vector<2>::Zero();
  };
  using Key = std::array<std::int64_t, 3>;  // path of either camera, and when

  explicit ShiftEquations(double systematic_weight) : prior(systematic_weight) {}

  Block& block_of(const Key& key) { return blocks.try_emplace(key, Block{prior * Matrix<2>::Identity()}).first->second; }

  /// apart + velocity · shift = systematic of all + of the pair + noise
  void add(Block& block, const Vector<2>& apart, const Vector<2>& velocity, const Matrix<2>& noise) {
    const Matrix<2> weight = kWeight * kSample_s / kMemory_s * noise.inverse();
    Eigen::Matrix<double, 2, 3> shared;
    shared << velocity, -Matrix<2>::Identity();
    normal += shared.transpose() * weight * shared;
    right -= shared.transpose() * weight * apart;
    block.own += weight;
    block.shared -= weight * shared;
    block.right += weight * apart;
    cost += apart.dot(weight * apart);
    samples += kWeight * kSample_s / kMemory_s;
  }

  void eliminate_blocks() {
    for (const auto& [key, block] : blocks) {
      const Matrix<2> inverse = block.own.inverse();
      normal -= block.shared.transpose() * inverse * block.shared;
      right -= block.shared.transpose() * inverse * block.right;
      cost -= block.right.dot(inverse * block.right);
    }
  }

  double prior;
  std::map<Key, Block> blocks;
  Matrix<3> normal = Eigen::Vector3d(0, prior, prior).asDiagonal();
  Vector<3> right = Vector<3>::Zero();
  double cost = 0, samples = 0;
};

}  // namespace

GroundPair::GroundPair(const std::vector<SmoothPath>& a, const std::vector<SmoothPath>& b, const GroundOffsetOptions& options)
    : b_(&b), options_(options) {
  if (a.empty() || b.empty()) return;
  const auto [a_begin, a_end] = span_of(a);
  std::tie(b_begin_, b_end_) = span_of(b);
  first_s_ = std::max(-options.max_offset_s, a_begin + options.min_common_s - b_end_);
  last_s_ = std::min(options.max_offset_s, a_end - options.min_common_s - b_begin_);
  present_.resize(static_cast<std::size_t>((b_end_ - b_begin_) / kTick_s) + 2);
  std::set<std::pair<int, int>> cells;
  for (std::size_t j = 0; j < b.size(); ++j) {
    for (double t = std::ceil((b[j].begin_s() - b_begin_) / kTick_s) * kTick_s + b_begin_; t < b[j].end_s(); t += kTick_s) {
      const auto state = b[j].at(t);
      if (!state) continue;
      present_[static_cast<std::size_t>(std::lround((t - b_begin_) / kTick_s))].push_back({j, state->location});
      cells.insert(cell_of(state->location));
    }
  }
  cut(a, cells);
}

/// Cuts paths into segments, and keeps of those that are informative so many as are enough.
void GroundPair::cut(const std::vector<SmoothPath>& a, const std::set<std::pair<int, int>>& cells) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (double begin = a[i].begin_s(); begin < a[i].end_s(); begin += kStride_s) {
      Segment segment{i, {}, {}};
      for (int k = 0; k < kSegmentSamples; ++k) {
        const double time = begin + kSample_s * k;
        if (const auto state = a[i].at(time)) segment.times_s.push_back(time), segment.states.push_back(*state);
      }
      if (segment.states.size() < kMinSegmentSamples) continue;
      const auto common = std::count_if(segment.states.begin(), segment.states.end(),
                                        [&](const SmoothPath::State& state) { return cells.contains(cell_of(state.location)); });
      const double common_s = kWeight * kSample_s * static_cast<double>(common);
      overlap_s_ += common_s;
      if (common == 0 || (segment.states.back().location - segment.states.front().location).norm() < kWalks_m) continue;
      moving_s_ += common_s;
      segments_.push_back(std::move(segment));
    }
  }
  if (segments_.size() <= kMaxSegments) return;
  std::vector<Segment> some;
  for (std::size_t i = 0; i < kMaxSegments; ++i) some.push_back(std::move(segments_[i * segments_.size() / kMaxSegments]));
  segments_ = std::move(some);
}

/// Of the segment being the same person's as `other` against another's; nothing if they are not to be compared.
std::optional<double> GroundPair::likelihood_ratio(const Segment& segment, const SmoothPath& other, double shift_s) const {
  double count = 0;
  Vector<2> mean = Vector<2>::Zero();
  Matrix<2> square = Matrix<2>::Zero(), noise = Matrix<2>::Zero();
  for (std::size_t k = 0; k < segment.states.size(); ++k) {
    const auto there = other.at(segment.times_s[k] - shift_s);
    if (!there) continue;
    const Vector<2> apart = segment.states[k].location - there->location;
    count += 1;
    mean += apart;
    square += apart * apart.transpose();
    noise += noise_scale_ * (segment.states[k].noise + there->noise);
  }
  if (count < kMinSegmentSamples) return std::nullopt;
  mean /= count;
  noise = noise / count + kFloor_m * kFloor_m * Matrix<2>::Identity();
  const Matrix<2> spread = square / count - mean * mean.transpose();
  const double merit = count * kSample_s / kMemory_s;  // independent samples
  const double systematic = options_.systematic_m * options_.systematic_m;
  const Matrix<2> of_mean = systematic * Matrix<2>::Identity() + noise / merit;
  const Matrix<2> different = noise + kDifferent_m * kDifferent_m * Matrix<2>::Identity();
  const double same_mean =
      -0.5 * mean.dot(of_mean.inverse() * mean) - std::log(2 * std::numbers::pi) - 0.5 * log_det(of_mean) - std::log(kDensity);
  const double same_motion =
      -0.5 * (merit - 1) *
      ((noise.inverse() * spread).trace() + log_det(noise) - (different.inverse() * spread).trace() - log_det(different));
  return same_mean + same_motion;
}

/// Who of the other camera's people it most likely is.
std::optional<GroundPair::Match> GroundPair::match(const Segment& segment, double shift_s) const {
  const std::size_t middle = segment.states.size() / 2;
  const double tick = std::round((segment.times_s[middle] - shift_s - b_begin_) / kTick_s);
  if (!(tick >= 0) || tick >= static_cast<double>(present_.size())) return std::nullopt;
  std::optional<Match> best;
  for (const auto& [path, location] : present_[static_cast<std::size_t>(tick)]) {
    if ((location - segment.states[middle].location).squaredNorm() > kMaxDistance_m * kMaxDistance_m) continue;
    const auto ratio = likelihood_ratio(segment, (*b_)[path], shift_s);
    if (ratio && (!best || *ratio > best->score)) best = Match{path, *ratio};
  }
  return best;
}

double GroundPair::score(double shift_s) const {
  double sum = 0;
  for (const Segment& segment : segments_) {
    const auto found = match(segment, shift_s);
    // As likely as not the other camera did not see the person at all: what speaks against costs little.
    if (found)
      sum += kWeight * (found->score > 0 ? found->score + std::log1p(std::exp(-found->score)) : std::log1p(std::exp(found->score)));
  }
  return sum;
}

/// Shifts that are better than those beside, and by how much peaks differ by chance.
GroundPair::Peaks GroundPair::peaks() const {
  std::vector<double> scores;
  for (double shift = first_s_; shift <= last_s_; shift += kStep_s) scores.push_back(score(shift));
  std::vector<std::pair<double, double>> found;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (scores[i] <= 0 || (i > 0 && scores[i - 1] >= scores[i]) || (i + 1 < scores.size() && scores[i + 1] > scores[i])) continue;
    found.emplace_back(-scores[i], first_s_ + kStep_s * static_cast<double>(i));
  }
  std::sort(found.begin(), found.end());
  Peaks result;
  for (const auto& peak : found) {
    if (result.shifts_s.size() < kPeaks) result.shifts_s.push_back(peak.second);
  }
  // The best may be the true one; of the others half lie below the second quarter's end.
  if (found.size() >= 5) {
    const auto others = std::span(found).subspan(1);
    result.chance = others[others.size() / 2].first - others[others.size() / 8].first;
  }
  return result;
}

/// One step of least squares: the shift, the systematic part of all pairs, and that of each, which is eliminated.
std::optional<GroundPair::Fit> GroundPair::step(double shift_s) const {
  ShiftEquations equations(1 / (options_.systematic_m * options_.systematic_m));
  for (const Segment& segment : segments_) {
    const auto found = match(segment, shift_s);
    if (!found || found->score < kPaired) continue;
    const auto when = static_cast<std::int64_t>(std::floor(segment.times_s[0] / kBlock_s));
    auto& block = equations.block_of({static_cast<std::int64_t>(segment.path), static_cast<std::int64_t>(found->path), when});
    for (std::size_t k = 0; k < segment.states.size(); ++k) {
      const auto there = (*b_)[found->path].at(segment.times_s[k] - shift_s);
      if (!there) continue;
      const Matrix<2> noise = noise_scale_ * (segment.states[k].noise + there->noise) + kFloor_m * kFloor_m * Matrix<2>::Identity();
      equations.add(block, segment.states[k].location - there->location, there->velocity, noise);
    }
  }
  equations.eliminate_blocks();
  const Eigen::LDLT<Matrix<3>> solver(equations.normal);
  const auto blocks = static_cast<double>(equations.blocks.size());
  if (blocks == 0 || solver.info() != Eigen::Success || !solver.isPositive() || !(equations.normal(0, 0) > 1e-9))
    return std::nullopt;
  const Vector<3> by = solver.solve(equations.right);
  const double variance = solver.solve(Vector<3>::UnitX()).x();
  if (!(variance > 0) || !std::isfinite(by.x())) return std::nullopt;
  const double free = 2 * equations.samples - 2 * blocks - 1;
  const double misfit = free > kMinFree ? std::max(0.0, equations.cost - equations.right.dot(by)) / free : 1;
  return Fit{shift_s + std::clamp(by.x(), -kStep_s, kStep_s), kOptimism * std::sqrt(variance), 0, misfit};
}

std::optional<GroundPair::Fit> GroundPair::refine(double shift_s) const {
  std::optional<Fit> fit;
  for (int i = 0; i < kIterations; ++i) {
    const double from = fit ? fit->shift_s : shift_s;
    fit = step(from);
    if (!fit) return std::nullopt;
    if (std::abs(fit->shift_s - from) < 1e-4) break;
  }
  fit->score = score(fit->shift_s);
  return fit;
}

/// Of those who walk where the other camera sees people, and while it videos, the share that it sees walk there too.
double GroundPair::explained(double shift_s) const {
  double all = 0, matched = 0;
  for (const Segment& segment : segments_) {
    if (segment.times_s.front() - shift_s < b_begin_ || segment.times_s.back() - shift_s > b_end_) continue;
    all += 1;
    const auto found = match(segment, shift_s);
    if (found && found->score > kPaired) matched += 1;
  }
  return all > 0 ? matched / all : 0;
}

/// Peaks, refined, the best first.
std::vector<GroundPair::Fit> GroundPair::fits(const std::vector<double>& peaks) const {
  std::vector<Fit> fits;
  for (const double peak : peaks) {
    if (const auto fit = refine(peak); fit && fit->shift_s >= first_s_ - kStep_s && fit->shift_s <= last_s_ + kStep_s)
      fits.push_back(*fit);
  }
  std::stable_sort(fits.begin(), fits.end(), [](const Fit& x, const Fit& y) { return x.score > y.score; });
  return fits;
}

GroundOffset GroundPair::find(std::optional<double> near) {
  GroundOffset result;
  if (overlap_s_ < kMinOverlap_s) return result;
  result.verdict = moving_s_ < kMinMoving_s ? OffsetVerdict::no_motion : OffsetVerdict::ambiguous;
  if (result.verdict == OffsetVerdict::no_motion) return result;
  const Peaks coarse = near ? Peaks{{*near}, 0} : peaks();
  std::vector<Fit> fits = this->fits(coarse.shifts_s);
  // Covariances speak of how wrong a place may be at all; how much that changes from one instant to the next, the paths show.
  for (int i = 0; i < kNoiseRounds && !fits.empty(); ++i) {
    noise_scale_ = std::clamp(noise_scale_ * fits[0].misfit, kMinNoise, 1 / kMinNoise);
    std::vector<double> again;
    for (const Fit& fit : fits) again.push_back(fit.shift_s);
    fits = this->fits(again);
  }
  if (fits.empty()) return result;
  const Fit& best = fits[0];
  const auto rival = std::find_if(fits.begin() + 1, fits.end(),
                                  [&](const Fit& fit) { return std::abs(fit.shift_s - best.shift_s) > kSamePeak_s; });
  const double gap = best.score - (rival == fits.end() ? 0 : rival->score);
  result.offset_s = best.shift_s;
  result.deviation_s = best.deviation_s;
  if (gap >= std::max(options_.min_score, kStandsOut * coarse.chance) && explained(best.shift_s) >= kExplained &&
      best.deviation_s <= options_.max_deviation_s)
    result.verdict = OffsetVerdict::found;
  return result;
}

}  // namespace marey::calibrate::pitch

#include "marey/reconstruct/keypoints/clock_offsets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include <Eigen/LU>

#include "marey/reconstruct/keypoints/person_view.h"
#include "marey/reconstruct/keypoints/ray_pair.h"

namespace marey::reconstruct::keypoints {
namespace {

constexpr int kBlocks = 10;       // of time, for the jackknife
constexpr double kBound = 25;     // squared standard deviations of a point
constexpr double kMaxMisfit = 9;  // of a person: no person there is the same
constexpr int kMinPoints = 4;
constexpr int kRounds = 20;
constexpr std::size_t kKept = 2;  // frames in memory, times the candidates
constexpr double kFlat = 0.02;    // a parabola that rises by less than this over its width says nothing

/// The mean misfit of a pair of cameras at each candidate offset, by block of time.
struct PairCost {
  std::size_t a = 0, b = 0;
  std::vector<std::array<double, kBlocks>> sums;  // by candidate
  std::vector<std::array<double, kBlocks>> counts;

  double mean(std::size_t candidate, int without) const {
    double sum = 0, count = 0;
    for (int block = 0; block < kBlocks; ++block) {
      if (block == without) continue;
      sum += sums[candidate][static_cast<std::size_t>(block)];
      count += counts[candidate][static_cast<std::size_t>(block)];
    }
    return count > 0 ? sum / count : kMaxMisfit;
  }
};

double misfit_of(const PersonView& a, const PersonView& b) {
  double sum = 0;
  int count = 0;
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    if (!a.points[i] || !b.points[i]) continue;
    const auto pair = pass_of(*a.points[i], *b.points[i]);
    sum += pair ? std::min(kBound, pair->square) : kBound;
    ++count;
  }
  return count < kMinPoints ? kMaxMisfit : std::min(kMaxMisfit, sum / count);
}

class OffsetSearch {
 public:
  OffsetSearch(std::span<const CameraFrames> cameras, const ClockOptions& options) : cameras_(cameras), options_(options) {
    for (const CameraFrames& camera : cameras) {
      if (camera.camera != nullptr) step_s_ = step_s_ == 0 ? 1 / camera.rate_hz : std::min(step_s_, 1 / camera.rate_hz);
    }
    farthest_ = static_cast<int>(std::lround(options.farthest_s / step_s_));
    choose_fixed();
    for (std::size_t a = 0; a < cameras.size(); ++a) {
      for (std::size_t b = a + 1; b < cameras.size(); ++b) {
        if (cameras[a].camera != nullptr && cameras[b].camera != nullptr && !(fixed_[a] && fixed_[b]))
          pairs_.push_back(cost_of(a, b));
      }
    }
  }

  std::vector<std::optional<ClockOffset>> solve() const {
    const auto [all, disagreement] = offsets_without(-1);
    std::vector<double> spread(cameras_.size(), 0);
    std::vector<double> mean(cameras_.size(), 0);
    std::vector<std::vector<double>> parts;
    for (int block = 0; block < kBlocks; ++block) parts.push_back(offsets_without(block).offsets);
    for (const auto& part : parts) {
      for (std::size_t c = 0; c < part.size(); ++c) mean[c] += part[c] / kBlocks;
    }
    for (const auto& part : parts) {
      for (std::size_t c = 0; c < part.size(); ++c) spread[c] += (part[c] - mean[c]) * (part[c] - mean[c]);
    }
    std::vector<std::optional<ClockOffset>> found(cameras_.size());
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      if (cameras_[c].camera == nullptr || fixed_[c]) continue;
      const double sigma = std::sqrt((kBlocks - 1.0) / kBlocks * spread[c] + disagreement[c]);
      if (std::isfinite(all[c]) && sigma <= options_.max_sigma)
        found[c] = ClockOffset{cameras_[c].offset_s + all[c] * step_s_, sigma * step_s_};
    }
    return found;
  }

 private:
  /// The cameras that are known; where none is, the first.
  void choose_fixed() {
    fixed_.assign(cameras_.size(), false);
    bool any = false;
    for (std::size_t c = 0; c < cameras_.size(); ++c) {
      fixed_[c] = cameras_[c].camera != nullptr && cameras_[c].known;
      any |= fixed_[c];
    }
    for (std::size_t c = 0; c < cameras_.size() && !any; ++c) any = fixed_[c] = cameras_[c].camera != nullptr;
  }

  std::vector<PersonView> views_at(std::size_t c, std::size_t frame) const {
    std::vector<PersonView> views;
    const auto& people = (*cameras_[c].people)[frame];
    for (std::size_t i = 0; i < people.size(); ++i)
      views.push_back(view_of(*cameras_[c].camera, static_cast<int>(c), static_cast<int>(i), people[i], 1));
    return views;
  }

  PairCost cost_of(std::size_t a, std::size_t b) const {
    PairCost cost{.a = a, .b = b, .sums = {}, .counts = {}};
    cost.sums.resize(static_cast<std::size_t>(4 * farthest_ + 1));
    cost.counts.resize(cost.sums.size());
    const auto &one = cameras_[a], &other = cameras_[b];
    const std::size_t frames = one.people->size(),
                      step = std::max<std::size_t>(1, frames / static_cast<std::size_t>(options_.samples));
    std::map<std::size_t, std::vector<PersonView>> known;  // of the other camera, by frame
    for (std::size_t k = 0; k < frames; k += step) {
      const std::vector<PersonView> here = views_at(a, k);
      if (here.empty()) continue;
      const auto block = k * kBlocks / frames;
      for (std::size_t candidate = 0; candidate < cost.sums.size(); ++candidate) {
        const double shift = (static_cast<double>(candidate) - 2 * farthest_) * step_s_;
        const double time = static_cast<double>(k) / one.rate_hz + one.offset_s - other.offset_s - shift;
        const double frame = std::round(time * other.rate_hz);
        if (frame < 0 || frame >= static_cast<double>(other.people->size())) continue;
        const auto [there, is_new] = known.try_emplace(static_cast<std::size_t>(frame));
        if (is_new) there->second = views_at(b, static_cast<std::size_t>(frame));
        for (const PersonView& person : here) {
          double minimum = kMaxMisfit;
          for (const PersonView& same : there->second) minimum = std::min(minimum, misfit_of(person, same));
          cost.sums[candidate][block] += minimum;
          cost.counts[candidate][block] += 1;
        }
      }
      while (known.size() > cost.sums.size() * kKept) known.erase(known.begin());
    }
    return cost;
  }

  double at(const PairCost& pair, double shift, int without) const {
    const double candidate = std::clamp(std::round(shift) + 2 * farthest_, 0.0, static_cast<double>(pair.sums.size() - 1));
    return pair.mean(static_cast<std::size_t>(candidate), without);
  }

  /// In whole steps: each camera in turn where the sum over its pairs is least.
  std::vector<double> whole_steps(int without) const {
    std::vector<double> offsets(cameras_.size(), 0);
    for (int round = 0; round < kRounds; ++round) {
      bool changed = false;
      for (std::size_t c = 0; c < cameras_.size(); ++c) {
        if (cameras_[c].camera == nullptr || fixed_[c]) continue;
        double best = offsets[c], minimum = -1;
        for (int candidate = -farthest_; candidate <= farthest_; ++candidate) {
          double sum = 0;
          for (const PairCost& pair : pairs_) {
            if (pair.a != c && pair.b != c) continue;
            if (round == 0 && std::max(pair.a, pair.b) > c) continue;  // the others are not set yet
            sum += at(pair, pair.b == c ? candidate - offsets[pair.a] : offsets[pair.b] - candidate, without);
          }
          if (minimum >= 0 && sum >= minimum) continue;
          minimum = sum;
          best = candidate;
        }
        changed |= best != offsets[c];
        offsets[c] = best;
      }
      if (!changed && round > 0) break;
    }
    return offsets;
  }

  struct Solved {
    std::vector<double> offsets;
    std::vector<double> disagreement;  // squared deviation, by how far the pairs' vertices lie from what all together have
  };

  /// What a pair says of the difference of its offsets: how sharply, and where its misfit is least. Steps.
  struct Parabola {
    Eigen::Index a = 0, b = 0;
    double curvature = 0, vertex = 0;
  };

  /// Nothing if the misfit is flat.
  std::optional<Parabola> parabola_of(const PairCost& pair, double middle, int without) const {
    const int half = std::max(2, static_cast<int>(std::lround(options_.vertex_s / step_s_)));
    double s0 = 0, s2 = 0, s4 = 0, y0 = 0, y1 = 0, y2 = 0;
    for (int d = -half; d <= half; ++d) {
      const double y = at(pair, middle + d, without), x = d;
      s0 += 1;
      s2 += x * x;
      s4 += x * x * x * x;
      y0 += y;
      y1 += y * x;
      y2 += y * x * x;
    }
    const double curvature = (s0 * y2 - s2 * y0) / (s0 * s4 - s2 * s2), slope = y1 / s2;
    if (!(curvature * half * half > kFlat)) return std::nullopt;
    const double vertex = std::clamp(-slope / (2 * curvature), -1.0 * half, 1.0 * half);
    return Parabola{static_cast<Eigen::Index>(pair.a), static_cast<Eigen::Index>(pair.b), curvature, middle + vertex};
  }

  /// Offsets in steps, by the parabolas of all pairs; infinite where no pair says anything of a camera.
  Solved offsets_without(int without) const {
    const std::vector<double> start = whole_steps(without);
    std::vector<Parabola> parabolas;
    for (const PairCost& pair : pairs_) {
      if (const auto of = parabola_of(pair, start[pair.b] - start[pair.a], without)) parabolas.push_back(*of);
    }
    return solved(parabolas);
  }

  Solved solved(const std::vector<Parabola>& parabolas) const {
    constexpr double kFixed = 1e9;
    const auto count = static_cast<Eigen::Index>(cameras_.size());
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(count, count);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(count);
    for (const Parabola& of : parabolas) {
      A(of.a, of.a) += of.curvature;
      A(of.b, of.b) += of.curvature;
      A(of.a, of.b) -= of.curvature;
      A(of.b, of.a) -= of.curvature;
      g(of.a) -= of.curvature * of.vertex;
      g(of.b) += of.curvature * of.vertex;
    }
    std::vector<bool> silent(cameras_.size(), false);
    for (Eigen::Index c = 0; c < count; ++c) {
      const auto index = static_cast<std::size_t>(c);
      const bool held = cameras_[index].camera == nullptr || fixed_[index];
      silent[index] = !held && A(c, c) == 0;
      if (held || silent[index]) A(c, c) += kFixed;
    }
    const Eigen::MatrixXd inverse = A.inverse();
    const Eigen::VectorXd offsets = inverse * g;
    double square = 0;
    for (const Parabola& of : parabolas) square += of.curvature * std::pow(offsets(of.b) - offsets(of.a) - of.vertex, 2);
    const auto unknown = std::count(fixed_.begin(), fixed_.end(), false);
    const double variance = square / static_cast<double>(std::max<std::ptrdiff_t>(1, std::ssize(parabolas) - unknown));
    Solved result{std::vector<double>(cameras_.size()), std::vector<double>(cameras_.size())};
    for (Eigen::Index c = 0; c < count; ++c) {
      const auto index = static_cast<std::size_t>(c);
      result.offsets[index] = silent[index] ? std::numeric_limits<double>::infinity() : offsets(c);
      result.disagreement[index] = variance * inverse(c, c);
    }
    return result;
  }

  std::span<const CameraFrames> cameras_;
  ClockOptions options_;
  double step_s_ = 0;
  int farthest_ = 0;  // steps
  std::vector<bool> fixed_;
  std::vector<PairCost> pairs_;
};

}  // namespace

std::vector<std::optional<ClockOffset>> find_clock_offsets(std::span<const CameraFrames> cameras, const ClockOptions& options) {
  return OffsetSearch(cameras, options).solve();
}

}  // namespace marey::reconstruct::keypoints

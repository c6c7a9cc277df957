#include "marey/solve/skeleton/whole.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <utility>

#include "marey/solve/skeleton/gaps.h"

namespace marey::solve::skeleton {
namespace {

constexpr double kSameRad = 0.035;  // 2°: two poses are one
constexpr double kOtherRad = 0.35;  // 20°: they are two
constexpr double kHiddenS = 2;      // markers that are away for longer are gone
constexpr double kInspectS = 0.1;   // between frames in which limbs are turned about
constexpr std::size_t kMaxInspections = 150;
constexpr int kMaxRotations = 4;  // a limb
constexpr double kClear = 10;     // σ² of a marker, in sum: less decides nothing

/// The motion from one frame to another.
struct TimeChunk {
  std::size_t begin = 0, end = 0;
  std::vector<std::vector<double>> rows;
  double gain = 0;
};

class FoldSettler {
 public:
  FoldSettler(const Skeleton& skeleton, std::span<std::vector<double>> rows, std::span<const ObservedMarkers> frames,
              double rate_hz, const PoseOptions& options)
      : skeleton_(skeleton),
        solver_(skeleton, options),
        tracker_(skeleton, options),
        rows_(rows),
        frames_(frames),
        rate_hz_(rate_hz),
        changed_(rows.size(), false) {
    solver_.learn_noise_of(rows, frames);  // one for all frames, so that their costs can be added
    for (std::size_t f = 0; f < rows.size(); ++f) observed_.push_back(solver_.inspect_at(rows[f], frames[f]).observed);
    find_gaps();
    for (std::size_t f = 0; f < rows.size(); ++f) costs_.push_back(cost(rows[f], f));
  }

  std::vector<bool> run() {
    try_backwards();
    for (std::size_t limb = 0; limb < solver_.limbs(); ++limb) try_rotated(limb);
    return std::move(changed_);
  }

 private:
  bool empty(std::size_t f) const {
    return std::none_of(frames_[f].begin(), frames_[f].end(), [](const auto& location) { return location.has_value(); });
  }

  /// Where markers are hidden a first pass has the others elsewhere than the skeleton: there it is first put where they are.
  double cost(const std::vector<double>& row, std::size_t f) {
    if (empty(f)) return 0;
    const SkeletonState state = solver_.articulation().state_of(row);
    return solver_.cost_of(gap_[f] ? solver_.solve_near(state, frames_[f]) : state, frames_[f]);
  }

  /// Frames in which a marker is hidden that is seen before and after.
  void find_gaps() {
    gap_.assign(frames_.size(), false);
    const auto hidden = static_cast<std::size_t>(std::max(1.0, kHiddenS * rate_hz_));
    for (const auto& of_segment : whole_frames(skeleton_, frames_, hidden)) {
      for (std::size_t f = 0; f < frames_.size(); ++f) gap_[f] = gap_[f] || of_segment[f].before != f;
    }
  }

  /// How far two rows are apart, rad, in angles that the frame's markers show.
  double apart(const std::vector<double>& row, std::size_t f) const {
    double maximum = 0;
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (skeleton_.coordinates[c].is_rotation && observed_[f][c])
        maximum = std::max(maximum, std::abs(std::remainder(row[c] - rows_[f][c], 2 * std::numbers::pi)));
    }
    return maximum;
  }

  /// From a pose at frame `from` on, in one direction, until it meets the solution: appends rows and what they cost less.
  void solve_onwards(std::vector<double> pose, std::size_t from, int direction, std::vector<std::vector<double>>& rows,
                     double& gain) {
    tracker_.start_from(std::move(pose));
    for (auto f = static_cast<std::ptrdiff_t>(from) + direction; f >= 0 && f < std::ssize(rows_); f += direction) {
      const auto at = static_cast<std::size_t>(f);
      const std::vector<double>& row = tracker_.step(1 / rate_hz_, frames_[at]).coordinates;
      if (apart(row, at) < kSameRad) return;
      gain += costs_[at] - cost(row, at);
      rows.push_back(row);
    }
  }

  void take(const TimeChunk& segment) {
    for (std::size_t f = segment.begin; f < segment.end; ++f) {
      rows_[f] = segment.rows[f - segment.begin];
      costs_[f] = cost(rows_[f], f);
      changed_[f] = true;
    }
  }

  /// Wherever the recording solved backwards differs.
  void try_backwards() {
    if (rows_.size() < 2) return;
    std::vector<std::vector<double>> back(rows_.size());
    back.back() = rows_.back();
    tracker_.start_from(rows_.back());
    for (std::size_t f = rows_.size() - 1; f-- > 0;) back[f] = tracker_.step(1 / rate_hz_, frames_[f]).coordinates;
    for (std::size_t f = 0; f < rows_.size();) {
      if (apart(back[f], f) < kSameRad) {
        ++f;
        continue;
      }
      TimeChunk other{.begin = f, .end = f, .rows = {}, .gain = 0};
      double maximum = 0;
      for (; f < rows_.size() && apart(back[f], f) >= kSameRad; ++f) {
        maximum = std::max(maximum, apart(back[f], f));
        other.gain += costs_[f] - cost(back[f], f);
        other.rows.push_back(back[f]);
      }
      other.end = f;
      if (maximum > kOtherRad && other.gain > kClear) take(other);
    }
  }

  /// The better of a limb's other poses in a frame, with what it costs less.
  std::pair<SkeletonState, double> rotated(std::size_t limb, std::size_t f) {
    std::pair<SkeletonState, double> best;
    for (const SkeletonState& from : solver_.other_poses(limb, solver_.articulation().state_of(rows_[f]))) {
      SkeletonState there = solver_.solve_near(from, frames_[f]);
      const double gain = costs_[f] - solver_.cost_of(there, frames_[f]);
      if (best.first.coordinates.empty() || gain > best.second) best = {std::move(there), gain};
    }
    return best;
  }

  void try_rotated(std::size_t limb) {
    const std::size_t step =
        std::max(static_cast<std::size_t>(std::max(1.0, kInspectS * rate_hz_)), rows_.size() / kMaxInspections + 1);
    std::vector<std::pair<double, std::size_t>> appearances;
    for (std::size_t f = step / 2; f < rows_.size(); f += step) {
      if (const double gain = rotated(limb, f).second; gain > 0) appearances.emplace_back(gain, f);
    }
    std::sort(appearances.rbegin(), appearances.rend());
    std::vector<bool> tried(rows_.size(), false);
    int rotations = 0;
    for (const auto& [gain, f] : appearances) {
      if (tried[f] || rotations++ >= kMaxRotations) continue;
      const TimeChunk other = from_rotated(limb, f);
      std::fill(tried.begin() + static_cast<std::ptrdiff_t>(other.begin), tried.begin() + static_cast<std::ptrdiff_t>(other.end),
                true);
      if (other.gain > kClear) take(other);
    }
  }

  TimeChunk from_rotated(std::size_t limb, std::size_t f) {
    const auto [state, gain] = rotated(limb, f);
    TimeChunk segment{.begin = f, .end = f + 1, .rows = {}, .gain = gain};
    solve_onwards(state.coordinates, f, -1, segment.rows, segment.gain);
    segment.begin -= segment.rows.size();
    std::reverse(segment.rows.begin(), segment.rows.end());
    segment.rows.push_back(state.coordinates);
    const std::size_t before = segment.rows.size();
    solve_onwards(state.coordinates, f, 1, segment.rows, segment.gain);
    segment.end += segment.rows.size() - before;
    return segment;
  }

  const Skeleton& skeleton_;
  PoseSolver solver_, tracker_;
  std::span<std::vector<double>> rows_;
  std::span<const ObservedMarkers> frames_;
  double rate_hz_;
  std::vector<bool> changed_, gap_;
  std::vector<std::vector<bool>> observed_;
  std::vector<double> costs_;
};

}  // namespace

std::vector<bool> settle_folds(const Skeleton& skeleton, std::span<std::vector<double>> rows,
                               std::span<const ObservedMarkers> frames, double rate_hz, const PoseOptions& options) {
  return FoldSettler(skeleton, rows, frames, rate_hz, options).run();
}

}  // namespace marey::solve::skeleton

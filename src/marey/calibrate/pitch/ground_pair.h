#pragma once

#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "marey/calibrate/pitch/ground_offset.h"
#include "marey/calibrate/pitch/ground_paths.h"

namespace marey::calibrate::pitch {

/// Two cameras' paths over one ground, and how well they agree when the second's clock is shifted.
class GroundPair {
 public:
  /// `b` must outlive it.
  GroundPair(const std::vector<SmoothPath>& a, const std::vector<SmoothPath>& b, const GroundOffsetOptions& options);

  /// The shift, added to b's times, that explains both best.
  /// `near`: where it must be, within some tenths of a second; else it is searched for.
  GroundOffset find(std::optional<double> near = std::nullopt);

  /// Person-seconds on ground that both see.
  double overlap_s() const { return overlap_s_; }

  /// Logarithm of the likelihood of the paths at this shift, but for a constant; nats.
  double score(double shift_s) const;

 private:
  struct Segment {
    std::size_t path = 0;
    std::vector<double> times_s;
    std::vector<SmoothPath::State> states;
  };
  struct Match {
    std::size_t path = 0;
    double score = 0;
  };
  struct Peaks {
    std::vector<double> shifts_s;  // the best first
    double chance = 0;             // nats
  };
  struct Fit {
    double shift_s = 0, deviation_s = 0, score = 0;
    double misfit = 1;  // of the noise, as a variance, to what it was taken for
  };

  struct Present {
    std::size_t path = 0;
    Vector<2> location;
  };

  void cut(const std::vector<SmoothPath>& a, const std::set<std::pair<int, int>>& cells);
  std::optional<Match> match(const Segment& segment, double shift_s) const;
  std::optional<double> likelihood_ratio(const Segment& segment, const SmoothPath& other, double shift_s) const;
  Peaks peaks() const;
  std::vector<Fit> fits(const std::vector<double>& peaks) const;
  std::optional<Fit> refine(double shift_s) const;
  std::optional<Fit> step(double shift_s) const;
  double explained(double shift_s) const;

  const std::vector<SmoothPath>* b_;  // outlives this
  GroundOffsetOptions options_;
  std::vector<Segment> segments_;
  std::vector<std::vector<Present>> present_;  // of b, at each step of a tenth of a second
  double b_begin_ = 0, b_end_ = 0;
  double overlap_s_ = 0, moving_s_ = 0;
  double noise_scale_ = 1;           // of covariances
  double first_s_ = 0, last_s_ = 0;  // shifts to be tried
};

}  // namespace marey::calibrate::pitch

#pragma once

#include <algorithm>

namespace marey::track {

/// Birth and death of targets, the same in an image and on the ground.
struct EvidenceOptions {
  double confident = 0.5;           ///< a target begins with scores of at least this; weaker ones only continue one
  double min_score = 0.05;          ///< observations with scores below this are ignored
  double confirm = 3;               ///< evidence that confirms a target: about this many confident observations
  double maximum = 10;              ///< evidence that is counted, at most
  double miss = 0.7;                ///< evidence that the misses of one instant cost, at most
  double newcomer_cost = 1;         ///< log-likelihood by which a target that is not confirmed comes after one that is
  double tentative_patience = 0.4;  ///< s unseen after which a target that is not confirmed is given up
  double duplicate_iou = 0.75;      ///< two boxes of one detector that overlap by more than this are one target's

  /// How long a confirmed target that should be seen and is not is waited for, s: no longer than it had been followed before,
  /// `followed` s, and a little more.
  double patience(double patience, double tracked) const { return std::min(patience, tracked + tentative_patience); }
};

/// How sure it is that there is a target at all: grows with each observation, by its score, and shrinks with each miss.
class Evidence {
 public:
  /// Begins with a first observation.
  Evidence(double score, const EvidenceOptions& options) : value_(of(score)), confirmed_(value_ >= options.confirm) {}

  void observe_frame(double score, const EvidenceOptions& options) {
    value_ = std::min(options.maximum, value_ + of(score));
    if (value_ >= options.confirm) confirmed_ = true;
  }
  void miss(double cost) { value_ -= cost; }

  /// Two targets turned out to be one.
  void absorb(const Evidence& other) {
    value_ = std::max(value_, other.value_);
    confirmed_ = confirmed_ || other.confirmed_;
  }

  /// Once confirmed, always.
  bool confirmed() const { return confirmed_; }
  /// The misses outweigh the observations.
  bool refuted() const { return value_ < 0; }

 private:
  static double of(double score) { return 0.4 + 0.8 * std::clamp(score, 0.0, 1.0); }

  double value_;
  bool confirmed_;
};

}  // namespace marey::track

// An open square: people come in at every side, alone and in groups, cross it, run, stand together or sit on benches for a while,
// and leave at another side permanently.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/simulate/random.h"

namespace marey::simulate::square {

struct SquareOptions {
  double length = 36, width = 12;  ///< m, of the observed part: x in [0, length], y in [0, width]
  double around = 4;               ///< m beyond it, where people come from and go to
  double arrivals = 1.1;           ///< groups a second
  double runners = 0.04;           ///< share of groups that run
  double stopping = 0.35;          ///< share of groups that stand or sit for a while on their path
  double stop_s = 30;              ///< how long on average
  int benches = 3;
};

struct SquarePerson {
  int id = 0;                              ///< from 1, never given twice
  Vector<2> location = Vector<2>::Zero();  ///< m
  Vector<2> velocity = Vector<2>::Zero();
  double height = 1.72;  ///< m
};

/// The same for the same seed, at whatever rate it is sampled: stepped at a fixed 25 Hz, between steps people go straight on.
class SquareMotion {
 public:
  SquareMotion(std::uint64_t seed, const SquareOptions& options = {});

  /// Goes to `time`, s since the beginning, at which the square has filled. Times must not go back.
  void advance(double time);

  std::span<const SquarePerson> people() const { return now_; }
  /// Whether a place lies in the observed part.
  bool holds(const Vector<2>& location) const;

 private:
  struct Walker {
    SquarePerson person;
    int group = 0;
    Vector<2> slot = Vector<2>::Zero();  // m beside the group's first: ahead, left
    double pace = 1.3;                   // m/s
    std::vector<Vector<2>> goals;        // of a group's first; the last is where it leaves
    double stop_for = 0;                 // s, at the first goal
  };

  void step();
  void arrive();
  Vector<2> at_side(int side);
  Vector<2> required(Walker& walker);
  Vector<2> pushed(const Walker& walker) const;
  const Walker* first_of(const Walker& walker) const;

  SquareOptions options_;
  Random random_;
  std::int64_t steps_ = 0;
  int next_id_ = 1, next_group_ = 1;
  std::vector<Vector<2>> benches_;
  std::vector<Walker> walkers_;  // a group's first stands before its others
  std::vector<SquarePerson> now_;
};

}  // namespace marey::simulate::square

// The particles: each is a guess of who is there, where, how fast and how large; a person has one identity in all of them.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/filter/random_stream.h"

namespace marey::track::bramble {

/// One person in one particle.
struct Blob {
  int id = 0;
  Vector<2> location = Vector<2>::Zero(), velocity = Vector<2>::Zero();  ///< m, m/s
  double stature = 1.75;                                                 ///< m
  double girth = 1;                                                      ///< factor
  int slot = -1;  ///< where this instant's shapes of it are; −1: not yet inspected
};

struct Particle {
  std::vector<Blob> people;  ///< by id
  double log_weight = 0;

  const Blob* find(int id) const;
  Blob* find(int id) { return const_cast<Blob*>(std::as_const(*this).find(id)); }
};

class ParticleSet {
 public:
  ParticleSet(int count, std::uint64_t seed);

  int size() const { return static_cast<int>(particles_.size()); }
  const std::vector<Particle>& all() const { return particles_; }
  /// A stream of random numbers of its own for each particle and call, the one who of several threads asks: `change` may be called
  /// from several at once.
  void each(const std::function<void(int index, Particle&, filter::RandomStream&)>& change);
  /// Draws as many particles again by their weights, in even steps, where few of them carry most of the weight, or `always`; they
  /// then weigh the same.
  void resample(bool always);
  /// Ids in any of the particles, ascending.
  std::vector<int> ids() const;

  /// What the particles together say of a person, all weighing the same.
  struct Estimate {
    double fraction = 0;  ///< of the particles, that hold it
    Blob mean;
    Matrix<2> covariance = Matrix<2>::Zero();  ///< of the place
  };
  Estimate estimate(int id) const;

 private:
  std::uint64_t seed_, calls_ = 0;
  std::vector<Particle> particles_, drawn_;
};

}  // namespace marey::track::bramble

#include "marey/track/bramble/particle_set.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <tbb/parallel_for.h>

namespace marey::track::bramble {
namespace {

constexpr double kFewEffective = 0.5;  // of the particles: below that they are drawn again

std::uint64_t mixed(std::uint64_t seed, std::uint64_t call, std::uint64_t index) {
  return filter::RandomStream(filter::RandomStream(seed ^ call * 0x9e3779b97f4a7c15ULL).bits() ^ index).bits();
}

}  // namespace

const Blob* Particle::find(int id) const {
  const auto at = std::lower_bound(people.begin(), people.end(), id, [](const Blob& blob, int sought) { return blob.id < sought; });
  return at != people.end() && at->id == id ? &*at : nullptr;
}

ParticleSet::ParticleSet(int count, std::uint64_t seed) : seed_(seed), particles_(static_cast<std::size_t>(count)) {}

void ParticleSet::each(const std::function<void(int, Particle&, filter::RandomStream&)>& change) {
  ++calls_;
  tbb::parallel_for(0, size(), [&](int i) {
    filter::RandomStream random(mixed(seed_, calls_, static_cast<std::uint64_t>(i)));
    change(i, particles_[static_cast<std::size_t>(i)], random);
  });
}

void ParticleSet::resample(bool always) {
  double maximum = particles_.front().log_weight;
  for (const Particle& one : particles_) maximum = std::max(maximum, one.log_weight);
  double sum = 0, squares = 0;
  for (const Particle& one : particles_) {
    const double weight = std::exp(one.log_weight - maximum);
    sum += weight, squares += weight * weight;
  }
  const auto count = static_cast<double>(particles_.size());
  if (!always && sum * sum > kFewEffective * count * squares) return;
  filter::RandomStream random(mixed(seed_, ++calls_, 0));
  const double step = sum / count;
  double next = random.uniform() * step, passed = 0;
  drawn_.resize(particles_.size());
  std::size_t drawn = 0;
  for (const Particle& one : particles_) {
    passed += std::exp(one.log_weight - maximum);
    for (; drawn < drawn_.size() && next < passed; next += step) {
      drawn_[drawn].people = one.people;
      drawn_[drawn++].log_weight = 0;
    }
  }
  while (drawn > 0 && drawn < drawn_.size()) drawn_[drawn] = drawn_[drawn - 1], ++drawn;  // what rounding left
  std::swap(particles_, drawn_);
}

std::vector<int> ParticleSet::ids() const {
  std::set<int> found;
  for (const Particle& one : particles_) {
    for (const Blob& blob : one.people) found.insert(blob.id);
  }
  return {found.begin(), found.end()};
}

ParticleSet::Estimate ParticleSet::estimate(int id) const {
  Estimate result;
  Blob& mean = result.mean;
  mean.id = id;
  mean.stature = mean.girth = 0;
  double count = 0;
  const auto with_it = [&](const auto& use) {
    for (const Particle& one : particles_) {
      if (const Blob* blob = one.find(id)) use(*blob);
    }
  };
  with_it([&](const Blob& blob) {
    mean.location += blob.location, mean.velocity += blob.velocity, mean.stature += blob.stature, mean.girth += blob.girth;
    ++count;
  });
  result.fraction = count / static_cast<double>(particles_.size());
  if (count == 0) return result;
  mean.location /= count, mean.velocity /= count, mean.stature /= count, mean.girth /= count;
  with_it([&](const Blob& blob) {
    const Vector<2> off = blob.location - mean.location;
    result.covariance += off * off.transpose() / count;
  });
  return result;
}

}  // namespace marey::track::bramble

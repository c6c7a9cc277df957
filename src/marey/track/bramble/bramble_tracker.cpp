#include "marey/track/bramble/bramble_tracker.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "marey/core/error.h"
#include "marey/track/bramble/blob_search.h"
#include "marey/track/bramble/particle_set.h"

namespace marey::track::bramble {
namespace {

// Neighbouring points of the grid are not independent witnesses: of their sum this share counts.
constexpr double kIndependence = 0.08;
constexpr double kArrivals = 0.01;                // people a m² and second
constexpr double kDepartures = 0.001, kLost = 1;  // a person and second: in view; out of every camera's view
constexpr double kAcceleration = 4;               // of people, m/s^1.5
constexpr double kMinFraction = 0.5;              // of the particles, that must hold a person who is reported of
constexpr double kSettles = 0.2;                  // s for which a person must be held before being reported of
constexpr double kStature = 1.75, kStatureSpread = 0.08, kStatureSettles = 5;  // m, m, s
constexpr double kGirthSpread = 0.15, kGirthSettles = 0.4;                     // s
constexpr double kPositionJitter = 0.1;                                        // m/√s: feet are not where a body is
constexpr double kNewSpread = 0.25;                                            // m, round a candidate
constexpr double kNewSpeed = 1.5;                                              // m/s, of each coordinate
constexpr double kProposeArrival = 0.5;                                        // of the particles, at each candidate
constexpr double kProposeDeparture = 0.03;                                     // of the particles, of each person
constexpr double kCandidate = 3;                                               // nats that a candidate must be worth
constexpr double kRoom = 0.35;                                                 // m: no person stands nearer to another
constexpr double kRoomCost = 30;                                               // nats, of two in the same place
constexpr double kVisible = 0.35;        // of a person, that a camera must see to have seen it
constexpr double kPositionNoise = 0.05;  // m, of what is reported: cylinders are not people

/// An autoregressive step of first order: towards `mean`, with a spread that stays the same.
double settled(double value, double mean, double spread, double memory, double normal) {
  return mean + memory * (value - mean) + spread * std::sqrt(1 - memory * memory) * normal;
}

}  // namespace

class BrambleTracker::Impl {
 public:
  Impl(const BrambleOptions& options, std::shared_ptr<const GroundViews> views)
      : options_(options), views_(std::move(views)), particles_(options.particles, options.seed) {
    if (options.particles < 1) throw Error("{} particles; 1 is the least", options.particles);
    for (int i = 0; i < views_->cameras(); ++i) {
      if (views_->view_at(CameraId{i}, {}).camera() == nullptr)
        throw Error("camera {} is known by ground_from_image alone; bramble must know how tall people are seen: calibrate it",
                    i + 1);
    }
  }

  std::span<const Track<2>> step(Timestamp now, std::span<const CameraEvidence> views) {
    if (now_ && now <= *now_) throw Error("{}", "instants must follow each other");
    dt_ = now_ ? seconds(now - *now_) : 0.04;
    now_ = now;
    inspect_at(views);
    forget_slots();
    for (const int id : particles_.ids()) move_person(id);
    if (!options_.partitioned) particles_.resample(true);
    if (has_evidence()) welcome();
    particles_.resample(true);
    report();
    return tracks_;
  }

  std::span<const CameraObservations<2>> observations() const { return reported_; }
  std::span<const ObservationMatch> matches() const { return matches_; }

 private:
  struct Known {
    double held_s = 0;
    bool confirmed = false;
  };

  void inspect_at(std::span<const CameraEvidence> views) {
    detected_.assign(static_cast<std::size_t>(views_->cameras()), {});
    for (const CameraEvidence& one : views) {
      EvidenceView& detected = detected_.at(static_cast<std::size_t>(number(one.camera)));
      detected.view = &views_->view_at(one.camera, one.time);
      detected.late = seconds(one.time - *now_);
      detected.evidence = one.evidence.get();
      if (one.evidence) detected.sums = EvidenceSums(*one.evidence);
    }
  }
  bool has_evidence() const {
    return std::any_of(detected_.begin(), detected_.end(), [](const EvidenceView& one) { return one.evidence != nullptr; });
  }

  /// No person has been inspected.
  void forget_slots() {
    slots_ = 0;
    particles_.each([](int, Particle& particle, filter::RandomStream&) {
      for (Blob& blob : particle.people) blob.slot = -1;
    });
  }

  /// Where the shapes of a blob are, of all cameras.
  GridShape* shapes_of(int slot) { return &shapes_[static_cast<std::size_t>(slot) * detected_.size()]; }
  /// Room for one shape a particle and camera.
  int next_slots() {
    const int begin = slots_;
    slots_ += particles_.size();
    const std::size_t required = static_cast<std::size_t>(slots_) * detected_.size();
    if (shapes_.size() < required) shapes_.resize(required);
    return begin;
  }

  void project(const Blob& blob, GridShape* shapes) const {
    for (std::size_t c = 0; c < detected_.size(); ++c) {
      const EvidenceView& detected = detected_[c];
      if (detected.evidence == nullptr) {
        shapes[c] = {};
        continue;
      }
      const Vector<2> location = blob.location + detected.late * blob.velocity;
      const Vector<3> foot(location.x(), location.y(), detected.view->surface().height(location));
      const PersonCylinder person{.foot = foot, .stature = blob.stature, .girth = blob.girth};
      cover(cylinder_outline(*detected.view->camera(), person), *detected.evidence, shapes[c]);
    }
  }

  /// What a person adds to what the others of its particle explain who were inspected before, nats.
  double merit(const Particle& particle, const Blob& blob) {
    double gained = 0;
    thread_local std::vector<const GridShape*> others;
    for (std::size_t c = 0; c < detected_.size(); ++c) {
      if (detected_[c].evidence == nullptr) continue;
      others.clear();
      for (const Blob& other : particle.people) {
        if (other.slot >= 0 && other.id != blob.id) others.push_back(shapes_of(other.slot) + c);
      }
      gained += detected_[c].sums.gain(shapes_of(blob.slot)[c], others).evidence;
    }
    gained *= kIndependence;
    for (const Blob& other : particle.people) {
      if (other.slot < 0 || other.id == blob.id) continue;
      const double apart = (other.location - blob.location).norm();
      if (apart < kRoom) gained -= kRoomCost * (1 - apart / kRoom);
    }
    return gained;
  }

  bool in_view(const GridShape* shapes) const {
    return std::any_of(shapes, shapes + detected_.size(), [](const GridShape& shape) { return shape.points > 0; });
  }

  void move(Blob& blob, filter::RandomStream& random) const {
    const auto [push_x, push_y] = random.normal_pair();
    const auto [off_x, off_y] = random.normal_pair();
    const auto [taller, wider] = random.normal_pair();
    blob.location += dt_ * blob.velocity + kPositionJitter * std::sqrt(dt_) * Vector<2>(off_x, off_y);
    blob.velocity += kAcceleration * std::sqrt(dt_) * Vector<2>(push_x, push_y);
    blob.location += 0.5 * dt_ * kAcceleration * std::sqrt(dt_) * Vector<2>(push_x, push_y);
    blob.stature = settled(blob.stature, kStature, kStatureSpread, std::exp(-dt_ / kStatureSettles), taller);
    blob.girth = std::max(0.5, settled(blob.girth, 1, kGirthSpread, std::exp(-dt_ / kGirthSettles), wider));
  }

  /// Moves a person in every particle that holds it, or lets it go; weighs the result.
  void move_person(int id) {
    const int slots = next_slots();
    particles_.each([&](int i, Particle& particle, filter::RandomStream& random) {
      Blob* blob = particle.find(id);
      if (blob == nullptr) return;
      move(*blob, random);
      blob->slot = slots + i;
      project(*blob, shapes_of(blob->slot));
      const double stays = std::exp(-dt_ * (in_view(shapes_of(blob->slot)) ? kDepartures : kLost));
      if (random.uniform() < kProposeDeparture) {
        particle.log_weight += std::log((1 - stays) / kProposeDeparture);
        particle.people.erase(particle.people.begin() + (blob - particle.people.data()));
      } else {
        particle.log_weight += std::log(stays / (1 - kProposeDeparture)) + merit(particle, *blob);
      }
    });
    if (options_.partitioned) particles_.resample(false);
  }

  /// Those who may have arrived.
  void welcome() {
    const auto found = search_.find(detected_, explained(), kCandidate / kIndependence);
    for (const BlobSearch::Candidate& candidate : found) {
      arrive(candidate);
      particles_.resample(false);
    }
  }

  std::vector<std::vector<GridShape>> explained() {
    std::vector<std::vector<GridShape>> shapes(detected_.size());
    std::vector<GridShape> of_one(detected_.size());
    for (const int id : particles_.ids()) {
      const ParticleSet::Estimate estimate = particles_.estimate(id);
      if (estimate.fraction < kMinFraction) continue;
      project(estimate.mean, of_one.data());
      for (std::size_t c = 0; c < detected_.size(); ++c) shapes[c].push_back(of_one[c]);
    }
    return shapes;
  }

  void arrive(const BlobSearch::Candidate& candidate) {
    const int id = next_id_++, slots = next_slots();
    const double rate = kArrivals * dt_;
    particles_.each([&](int i, Particle& particle, filter::RandomStream& random) {
      if (random.uniform() >= kProposeArrival) {
        particle.log_weight -= std::log(1 - kProposeArrival);
        return;
      }
      const auto [x, y] = random.normal_pair();
      const auto [u, v] = random.normal_pair();
      const auto [taller, wider] = random.normal_pair();
      Blob& blob = particle.people.emplace_back();
      blob.id = id;
      blob.location = candidate.location + kNewSpread * Vector<2>(x, y);
      blob.velocity = kNewSpeed * Vector<2>(u, v);
      blob.stature = kStature + kStatureSpread * taller;
      blob.girth = std::max(0.5, 1 + kGirthSpread * wider);
      blob.slot = slots + i;
      project(blob, shapes_of(blob.slot));
      const double log_proposed = -0.5 * (x * x + y * y) - std::log(2 * std::numbers::pi * kNewSpread * kNewSpread);
      particle.log_weight += std::log(rate / kProposeArrival) - log_proposed + merit(particle, blob);
    });
  }

  /// Who is in most of the particles.
  void report() {
    tracks_.clear();
    std::map<int, Known> known;
    std::vector<std::vector<GridShape>> shapes;
    for (const int id : particles_.ids()) {
      const ParticleSet::Estimate estimate = particles_.estimate(id);
      Known one = known_.contains(id) ? known_[id] : Known{};
      if (estimate.fraction >= kMinFraction) {
        one.held_s += dt_;
        one.confirmed |= one.held_s >= kSettles;
        notify(estimate, one.confirmed);
        shapes.emplace_back(detected_.size());
        project(estimate.mean, shapes.back().data());
      }
      known.emplace(id, one);
    }
    known_ = std::move(known);
    note_observed(shapes);
  }

  void notify(const ParticleSet::Estimate& estimate, bool confirmed) {
    Track<2>& track = tracks_.emplace_back();
    track.id = TrackId{estimate.mean.id};
    track.position = estimate.mean.location;
    track.velocity = estimate.mean.velocity;
    track.covariance = estimate.covariance + kPositionNoise * kPositionNoise * Matrix<2>::Identity();
    track.confirmed = confirmed;
    track.score = estimate.fraction;
  }

  /// The cameras that see each person: a person with too small a visible part is not seen.
  void note_observed(const std::vector<std::vector<GridShape>>& shapes) {
    observations_.assign(detected_.size(), {});
    matches_.clear();
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      for (std::size_t c = 0; c < detected_.size(); ++c) {
        if (detected_[c].evidence != nullptr && observes(c, t, shapes))
          tracks_[t].cameras |= mask_of(CameraId{static_cast<int>(c)});
      }
      tracks_[t].provenance = tracks_[t].cameras != 0 ? Provenance::measured : Provenance::predicted;
      add_observations(tracks_[t]);
    }
    reported_.clear();
    for (std::size_t c = 0; c < detected_.size(); ++c) {
      if (detected_[c].view != nullptr) reported_.push_back({CameraId{static_cast<int>(c)}, *now_, observations_[c]});
    }
    for (ObservationMatch& match : matches_) {  // views are those that have a frame
      const auto at =
          std::find_if(reported_.begin(), reported_.end(), [&](const auto& one) { return number(one.camera) == match.view; });
      match.view = static_cast<int>(at - reported_.begin());
    }
  }

  bool observes(std::size_t camera, std::size_t track, const std::vector<std::vector<GridShape>>& shapes) const {
    const auto distance = [&](std::size_t t) {
      return (tracks_[t].position - detected_[camera].view->camera()->centre().head<2>()).norm();
    };
    std::vector<const GridShape*> before;
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      if (t != track && distance(t) < distance(track)) before.push_back(&shapes[t][camera]);
    }
    const GridShape& own = shapes[track][camera];
    const EvidenceSums::Gain gain = detected_[camera].sums.gain(own, before);
    return own.points > 0 && gain.points > kVisible * own.points && gain.evidence > 0;
  }

  /// What the particles say, as if each camera that sees the person had measured an equal share of it.
  void add_observations(const Track<2>& track) {
    const int cameras = static_cast<int>(std::popcount(track.cameras));
    for (std::size_t c = 0; c < detected_.size(); ++c) {
      const CameraId camera{static_cast<int>(c)};
      if ((track.cameras & mask_of(camera)) == 0) continue;
      Observation<2>& one = observations_[c].emplace_back();
      one.value = track.position;
      one.covariance = cameras * track.covariance;
      one.camera = camera;
      one.score = track.score;
      matches_.push_back({track.id, static_cast<int>(c), static_cast<int>(observations_[c].size()) - 1});
    }
  }

  BrambleOptions options_;
  std::shared_ptr<const GroundViews> views_;
  ParticleSet particles_;
  BlobSearch search_;
  std::optional<Timestamp> now_;
  double dt_ = 0;
  int next_id_ = 1;
  std::map<int, Known> known_;
  std::vector<EvidenceView> detected_;  // of each camera
  std::vector<GridShape> shapes_;       // a slot holds one of each camera
  int slots_ = 0;
  std::vector<Track<2>> tracks_;
  std::vector<std::vector<Observation<2>>> observations_;  // of each camera
  std::vector<CameraObservations<2>> reported_;
  std::vector<ObservationMatch> matches_;
};

BrambleTracker::BrambleTracker(const BrambleOptions& options, std::shared_ptr<const GroundViews> views)
    : impl_(std::make_unique<Impl>(options, std::move(views))) {}
BrambleTracker::~BrambleTracker() = default;
BrambleTracker::BrambleTracker(BrambleTracker&&) noexcept = default;

std::span<const Track<2>> BrambleTracker::step(Timestamp now, std::span<const CameraEvidence> views) {
  return impl_->step(now, views);
}

std::span<const CameraObservations<2>> BrambleTracker::observations() const {
  return impl_->observations();
}

std::span<const ObservationMatch> BrambleTracker::matches() const {
  return impl_->matches();
}

}  // namespace marey::track::bramble

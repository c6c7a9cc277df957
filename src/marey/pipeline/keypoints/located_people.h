// People in space as they come, instant by instant: each placed person keeps a number, and each of their points a causal filter,
// which carries it over instants in which it is not seen.
//
// Every point is a Kalman filter of constant velocity, with the noise density that the paths over whole recordings have
// (reconstruct/keypoints/trajectory.h). Numbers are reused: a person that is placed after another one has been absent for longer
// than people are searched (PeopleOptions::lost_s) gets the number of the nearest such one, so that a skeleton or a client of a
// stream continues with a person that returns. Cost: one filter step per point.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/instant.h"
#include "marey/core/keypoints.h"
#include "marey/filter/kalman.h"
#include "marey/reconstruct/keypoints/people_in_views.h"

namespace marey::pipeline::keypoints {

struct LocatedPeopleOptions {
  int maximum = 0;            ///< people who get a number; 0: all
  int settle = 3;             ///< instants in which a person is placed before they get one, unswept
  int max_refused = 3;        ///< measurements outside the gate, one after the other, after which a point starts again, unswept
  double max_sigma_m = 0.15;  ///< standard deviation of a triangulated point that is used, as for recordings
  double free_s = 1;          ///< after which a number is given to another person, unswept
  double predict_s = 0.2;     ///< that a point which is not seen is carried on, unswept
  filter::KalmanOptions filter{.acceleration_noise = 3.46, .initial_speed = 1.5, .gate_sigmas = 4};  ///< m; the gate unswept
};

class LocatedPeople {
 public:
  LocatedPeople(const KeypointSet& set, const LocatedPeopleOptions& options = {});

  /// Puts the tracks of an instant, `step_s` after the last one, into it: labels are "P1:left_knee", "P2:…".
  void step(std::span<const reconstruct::keypoints::LocatedPerson> people, double step_s, Instant& instant);

  /// Where the numbered person with this id of PeopleInViews is, by the set; empty if the id has no number.
  std::vector<std::optional<Vector<3>>> points_of(int person) const;
  /// The track of a person's point; nothing if the id has no number.
  std::optional<TrackId> track_of(int person, std::size_t point) const;
  /// How many numbers were given, and how many are in use.
  std::size_t numbers() const { return slots_.size(); }
  std::size_t present() const;
  /// What happened in the last step, one sentence each.
  std::vector<std::string> take_news();

 private:
  struct Point {
    filter::Kalman<3> filter;
    double unobserved_s = 0;
    int refused = 0;  // measurements outside the gate, one after the other
  };
  struct Slot {
    int person = 0;
    double unobserved_s = 0;
    std::vector<std::optional<Point>> points;
    Vector<3> location = Vector<3>::Zero();
    bool named = false;
  };
  struct Candidate {
    int person = 0, instants = 0;
  };

  Slot* slot_of(int person);
  const Slot* slot_of(int person) const;
  Slot* give_slot(const reconstruct::keypoints::LocatedPerson& person);
  void correct(Slot& slot, const reconstruct::keypoints::LocatedPerson& person) const;
  void notify(const Slot& slot, std::size_t number, const reconstruct::keypoints::LocatedPerson* detected, Instant& instant) const;

  KeypointSet set_;
  LocatedPeopleOptions options_;
  std::vector<Slot> slots_;
  std::vector<Candidate> candidates_;
  std::vector<std::string> news_;
};

}  // namespace marey::pipeline::keypoints

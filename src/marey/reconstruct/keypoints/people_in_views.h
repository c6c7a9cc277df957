// Which person in one camera's image is which in another one's, and where the keypoints are in space: frame by frame.
//
// People that are supported: expected where they were heading. In each camera the people of the image are given to those expected
// by the least sum of squared reprojection errors over all keypoints, each in standard deviations and bounded, so that a few wrong
// points decide nothing; no person is given two, and no person twice. Points left in two cameras or more begin a new person: of
// all pairs whose half-lines meet over most keypoints, and whose bones then have a body's lengths, the one that the most other
// cameras agree with, then the next. A camera in which a limb fits better with left and right exchanged, by what all cameras
// together know, is read so; where most cameras would have to be, none is.
//
// Points are triangulated by least squares with the keypoints' own deviations, without rays that the others contradict
// (reconstruct/triangulate.h). Assumed: cameras are synchronous to a few centimetres of motion, and every person is seen by two
// cameras at least. Cost: cameras × expected × seen × keypoints errors of a dozen multiplications, and one triangulation a
// keypoint. References: Bridgeman et al., "Multi-person 3D pose estimation and tracking in sports", CVPRW 2019; Dong et al., "Fast
// and robust multi-person 3D pose estimation from multiple views", CVPR 2019; RapidPoseTriangulation, arXiv 2503.21692.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "marey/assign/gated_assignment.h"
#include "marey/core/keypoints.h"
#include "marey/reconstruct/keypoints/person_view.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::reconstruct::keypoints {

struct PeopleOptions {
  double position_m = 0.06;   ///< how far a keypoint is off where it is expected, one standard deviation, unswept
  double position_m_s = 1.5;  ///< and how that grows while it is not seen, unswept
  double bound = 5;           ///< standard deviations from which an error counts no more
  double gate = 3;            ///< standard deviations, root mean square of bounded errors: farther off, a view is of another person
  double pair_gate = 2.2;     ///< the same of the rays of two views that begin a person
  double swap_gain = 4;       ///< standard deviations that a limb must fit better exchanged
  double lost_s = 1;          ///< a person not seen by two cameras for this long is gone
  double settle_s = 0.04;     ///< over which places and speeds are averaged
  int min_points = 4;         ///< of a view and a person in common
  TriangulateOptions triangulate{.false_alarm = 1e-3};
};

/// A person at one instant.
struct LocatedPerson {
  int id = 0;                                     ///< from 1, in the order of birth, never given twice
  std::vector<int> views;                         ///< by camera: index among the people of its image; −1 where it has none
  std::vector<Mirrored> mirrored;                 ///< by camera
  std::vector<std::optional<SpacePoint>> points;  ///< by the set; `used` has a bit for each camera
};

class PeopleInViews {
 public:
  PeopleInViews(const KeypointSet& set, int cameras, const PeopleOptions& options = {});

  /// The people that two views or more show, `seconds` after the last step. Valid until the next call.
  const std::vector<LocatedPerson>& step(double seconds, std::span<const PersonView> views);

  /// Of the views so far: how many there were, and how many of them belong to a placed person.
  std::int64_t views_observed() const { return views_observed_; }
  std::int64_t views_located() const { return views_located_; }

 private:
  struct Point {
    Vector<3> position = Vector<3>::Zero(), velocity = Vector<3>::Zero();
    double unobserved_s = 0;
  };
  struct Person {
    int id = 0;
    double unobserved_s = 0;
    std::vector<std::optional<Point>> points;
    bool is_new = true;
  };
  struct Start {
    std::vector<int> views;  // indices into the step's views
    std::vector<std::optional<Point>> points;
    double cost = 0;
  };

  void expect(Person& person, double seconds) const;
  std::optional<double> misfit(const Person& person, const PersonView& view) const;
  std::optional<double> point_misfit(const Point& point, const SightLine& line) const;
  void give_views(std::span<const PersonView> views);
  void begin_people(std::span<const PersonView> views);
  std::optional<Start> start_of(const PersonView& a, const PersonView& b) const;
  void extend(Start& start, std::span<const PersonView> views) const;
  bool is_body(const std::vector<std::optional<Point>>& points) const;
  std::optional<std::size_t> known_at(const Start& start) const;
  std::optional<LocatedPerson> location(Person& person, std::span<const PersonView> views, const std::vector<int>& own,
                                        double seconds);
  void find_mirrored(const Person& person, std::span<const PersonView> views, const std::vector<int>& own,
                     std::vector<Mirrored>& mirrored) const;
  void triangulate(std::span<const PersonView> views, const std::vector<int>& own, LocatedPerson& located,
                   const Person* expected) const;
  void learn(Person& person, const LocatedPerson& located, double seconds) const;

  KeypointSet set_;
  int cameras_;
  PeopleOptions options_;
  Triangulator triangulator_;
  std::vector<std::optional<Limb>> limbs_;
  std::vector<std::pair<int, int>> lengths_;  // bones whose lengths are known of people
  std::vector<Person> people_;
  std::vector<std::vector<int>> given_;  // by person: the step's views
  std::vector<char> taken_;              // by view
  std::vector<LocatedPerson> located_;
  assign::GatedAssigner assigner_;
  int next_id_ = 1;
  std::int64_t views_observed_ = 0, views_located_ = 0;
};

}  // namespace marey::reconstruct::keypoints

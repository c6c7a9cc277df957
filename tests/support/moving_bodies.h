#pragma once

// For tests of streams: a recording with labelled and other points, a body by itself, and a skeleton of two segments.

#include <cmath>

#include "marey/core/recording.h"
#include "marey/core/recording_reader.h"
#include "marey/geometry/rigid.h"

namespace marey::test {

/// About z, rad.
inline Matrix<3> rotated_about_z(double angle) {
  return geometry::rotation_from(Vector<3>(0, 0, angle));
}

inline Sample point_at(int track, const Vector<3>& position) {
  Sample point;
  point.track = TrackId(track);
  point.position = position;
  return point;
}

/// "racket" by itself with two markers; "dancer" with Hips, and LeftUpLeg below.
inline RecordingHeader header_of_moving_bodies() {
  RecordingHeader header;
  header.name = "bodies";
  header.rate_hz = 100;
  const BodyMarker corner{.label = "corner", .position = {0.1, 0, 0}}, tip{.label = "tip", .position = {0, 0.2, 0}};
  header.bodies.push_back({.id = BodyId(1), .label = "racket", .skeleton = {}, .parent = {}, .end = {}, .markers = {corner, tip}});
  header.bodies.push_back({.id = BodyId(2), .label = "Hips", .skeleton = "dancer", .parent = {}, .end = {}, .markers = {}});
  header.bodies.push_back({.id = BodyId(3),
                           .label = "LeftUpLeg",
                           .skeleton = "dancer",
                           .parent = BodyId(2),
                           .offset = {0.1, 0, -0.1},
                           .end = {},
                           .markers = {}});
  return header;
}

/// Instant k of 100 a second: point 1 "LASI" at (k/1000, 0, 1), point 2 "RASI" missing at every fifth, point 3 without label;
/// the racket at (0, k/1000, 1.5), turned by k/100 about z, lost at every seventh.
inline Instant moving_bodies(int k) {
  Instant instant;
  instant.index = k;
  instant.time = Timestamp(std::chrono::milliseconds(10 * k));
  if (k == 0) instant.named = {{.id = TrackId(1), .label = "LASI", .team = {}}, {.id = TrackId(2), .label = "RASI", .team = {}}};
  instant.samples.push_back(point_at(1, {k / 1000.0, 0, 1}));
  instant.samples.back().residual_m = 0.0005;
  if (k % 5 != 0) instant.samples.push_back(point_at(2, {0, 0.25, 1}));
  instant.samples.push_back(point_at(3, {1, 2, 3}));
  instant.samples.back().provenance = Provenance::predicted;
  const Rigid3 hips{.rotation = rotated_about_z(0.3), .translation = {1, 1, 1}};
  const Rigid3 leg = hips * Rigid3{.rotation = rotated_about_z(0.2), .translation = {0.1, 0, -0.1}};
  instant.bodies.push_back({.body = BodyId(1),
                            .world_from_body = {.rotation = rotated_about_z(k / 100.0), .translation = {0, k / 1000.0, 1.5}},
                            .covariance = {},
                            .residual_m = 0.001,
                            .tracked = k % 7 != 0});
  instant.bodies.push_back({.body = BodyId(2), .world_from_body = hips, .covariance = {}, .residual_m = {}});
  instant.bodies.push_back({.body = BodyId(3), .world_from_body = leg, .covariance = {}, .residual_m = {}});
  return instant;
}

/// This many of those instants as a recording.
class MovingBodies : public RecordingReader {
 public:
  explicit MovingBodies(int instants) : count_(instants), header_(header_of_moving_bodies()) {}
  const RecordingHeader& header() const override { return header_; }
  std::vector<TrackName> tracks() const override { return {}; }
  std::optional<Instant> next() override { return at_ < count_ ? std::optional(moving_bodies(at_++)) : std::nullopt; }

 private:
  int count_, at_ = 0;
  RecordingHeader header_;
};

}  // namespace marey::test

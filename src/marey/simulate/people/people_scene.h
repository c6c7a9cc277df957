#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/observation.h"

namespace marey::simulate::people {

/// A street seen by a camera at eye height or above: the people who walk there, and how the camera moves.
struct PeopleSceneOptions {
  int frames = 300;
  double rate_hz = 15;
  double width = 768;                 ///< px
  double height = 576;                ///< px
  double focal = 800;                 ///< px
  double camera_height = 2.5;         ///< m
  int people = 10;                    ///< in view at a time, about
  double nearest = 4, farthest = 22;  ///< m; where people walk
  double group_fraction = 0.3;        ///< of people who walk beside another
  double stop_fraction = 0.2;         ///< of people who stand still for some seconds
  double camera_speed = 0;            ///< m/s forward
  double camera_turn = 0;             ///< standard deviation of the turning rate, rad/s
  double camera_shake = 0;            ///< standard deviation of the pitch from frame to frame, rad
};

/// Where one person truly is in one frame.
struct TrueBox {
  int frame = 0;  ///< 0-based
  int id = 0;     ///< from 1
  Box box;        ///< the whole person, hidden parts included, px
};

/// People who walk through the image, side by side, across each other, standing at times. In the order of frames, then ids.
std::vector<TrueBox> simulate_people(const PeopleSceneOptions& options, std::uint64_t seed);

/// How a detector errs. Its misses last, its boxes wander, its false alarms come back to the same places.
struct DetectorModel {
  double miss = 0.12;             ///< share of visible people missed
  double miss_duration = 0.3;     ///< s that a miss lasts on average
  double position_noise = 0.025;  ///< standard deviation of a centre, in heights of the person
  double size_noise = 0.045;      ///< standard deviation of the logarithm of width and height
  double noise_memory = 0.1;      ///< s over which an error persists
  double hidden_from = 0.35;      ///< people with a smaller visible share are not seen
  double clip_chance = 0.5;       ///< that a box of a person partly hidden spans the visible part only
  double false_alarms = 0.15;     ///< a frame, anywhere
  int haunted_positions = 2;      ///< that look like a person, half of the time
};

/// What such a detector says of the truth, frame by frame, with scores that are informative but not more.
std::vector<std::vector<Observation<2>>> simulate_detector(std::span<const TrueBox> truth, int frames, double rate_hz,
                                                           const DetectorModel& model, std::uint64_t seed);

}  // namespace marey::simulate::people

#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/geometry.h"
#include "marey/core/ids.h"

namespace marey {

/// Where people were on the ground throughout a recording.
struct GroundRecording {
  struct Person {
    int id = 0;         ///< positive, unique
    std::string label;  ///< a name or a shirt's number; empty where none was given
    std::string team;   ///< empty where it is not known
  };
  struct Sample {
    std::int32_t frame = 0;
    std::int32_t person = 0;                 ///< index into `people`
    double time = 0;                         ///< s
    Vector<2> place = Vector<2>::Zero();     ///< m
    Vector<2> velocity = Vector<2>::Zero();  ///< m/s
    CameraMask cameras = 0;                  ///< a bit each that saw the person, in the order of `cameras`
    bool observed = true;                    ///< else it is where the person was expected
  };

  std::vector<std::string> cameras;
  std::vector<Person> people;
  std::vector<Sample> samples;  ///< by frame, then by person's id; one a person and frame
};

}  // namespace marey

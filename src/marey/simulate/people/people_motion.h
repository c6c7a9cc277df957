#pragma once

#include <vector>

#include "marey/simulate/people/people_video.h"

namespace marey::simulate::people {

/// Who stands where in each frame of a video, and what hides them.
struct PeopleMotion {
  struct Located {
    int id = 0;  ///< from 1: figures[id − 1]
    Stance stance;
  };
  std::vector<Figure> figures;
  std::vector<std::vector<Located>> frames;
  std::vector<Post> posts;
};

/// Lets people move as a situation asks, before a camera. `options.frames` and `options.people` must be given.
PeopleMotion move_people(PeopleSituation situation, const LevelCamera& camera, const PeopleVideoOptions& options, Random& random);

}  // namespace marey::simulate::people

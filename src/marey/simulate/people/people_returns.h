#pragma once

#include "marey/simulate/people/people_motion.h"

namespace marey::simulate::people {

/// PeopleSituation::returns. A person who leaves walks about outside, at paces of their own, and comes back where that has led
/// them.
PeopleMotion move_returning(const LevelCamera& camera, const PeopleVideoOptions& options, Random& random);

}  // namespace marey::simulate::people

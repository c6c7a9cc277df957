#pragma once

#include <string>
#include <string_view>

#include "marey/detect/people/people.h"

namespace marey::detect::network {

/// The detector as the register of detectors knows it (detect/detectors.h).
struct NetworkDetectorOptions {
  static constexpr std::string_view name = "network";

  std::string model = {};  ///< a file that describes a network (model_file.h)
  bool background =
      true;  ///< a background model beside it, which sees the one who moves between the frames that the network processes
  double score_factor = 1;   ///< times the least score that the file names: less where something else says who is a person
  int every = 1;             ///< the network processes every n-th frame
  double everywhere_s = 2;   ///< the network searches all over the image this often, or up to four times as rarely
  double first_height = 84;  ///< px: as high people are taken to be until some were found
  people::PeopleDetectorOptions people = {};  ///< the background model and, where they are known, the sizes of people
};

}  // namespace marey::detect::network

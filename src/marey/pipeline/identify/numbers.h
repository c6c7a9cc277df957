// Shirt numbers that were read in images (people/number_sink.h), as annotations of who is who.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "marey/pipeline/identify/people.h"

namespace marey::pipeline::identify {

/// A row of the file of numbers.
struct ReadNumber {
  int track = 0;
  std::string number;
  double probability = 0;
  double time_s = 0;  ///< by the recording's clock
  std::string where;  ///< "numbers.csv:3"
};

/// Throws Error, with file and line, where a row is not as `marey track --numbers` writes it, or a track is there twice.
std::vector<ReadNumber> parse_numbers(std::string_view text, const std::string& name);
std::vector<ReadNumber> read_numbers(const std::string& path);

struct NumberNamings {
  std::vector<SquadNaming> namings;   ///< by time
  std::vector<std::string> messages;  ///< a sentence for each number that is probable enough and not among them
};

/// The numbers of at least this probability that decide on one member of the squads each, by the track's team where the take has
/// it. A number names no person if its track or its member was named by hand (`given`), no member or several have it, or two tracks
/// that are there at the same time have it. Throws Error, with the row, for a track that the take lacks.
NumberNamings namings_by_numbers(const std::vector<ReadNumber>& numbers, double min_probability,
                                 const std::vector<SquadMember>& squads, const std::vector<SquadNaming>& given,
                                 const Recording& recording);

}  // namespace marey::pipeline::identify

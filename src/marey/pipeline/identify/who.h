// Who is who in a take of people on the ground: names that people gave are carried along, what is in doubt is listed, and answers
// are applied. Nothing recorded is changed; all of it are edits.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/pipeline/identify/who_doubts.h"

namespace marey::pipeline::identify {

struct WhoOptions {
  std::string roster;   ///< CSV: number,name,team
  std::string names;    ///< CSV: time,id,name
  std::string doubts;   ///< CSV to be written; empty: not
  double least = 0.02;  ///< what is less probable to be wrong is not listed
};

struct WhoSummary {
  struct Person {
    std::string label, team;
    int track = 0;
    double known_s = 0;
  };
  double recorded_s = 0;
  std::vector<Person> people;  ///< who were named, in the roster's order
  double unnamed_s = 0;        ///< that others are there for, together
  std::int64_t left_out = 0;   ///< places that were deleted: of somebody who is elsewhere then, or between two people
  std::vector<Doubt> doubts;
  std::int64_t edits = 0;
};

/// Names people and carries the names on. Throws Error, and changes nothing, for what does not fit: see format/match/squads.h and
/// who_people.h.
WhoSummary name_people(const std::string& take, const WhoOptions& options, const Hooks& hooks = {});

struct AnswerSummary {
  std::int64_t answered = 0, blank = 0;
  std::int64_t before = 0;  ///< of those answered, how many were applied already
  std::int64_t edits = 0;
};

/// Applies the answers of a list of doubts, all or none. `roster` may be empty.
AnswerSummary apply_answers(const std::string& take, const std::string& doubts, const std::string& roster, const Hooks& hooks = {});

}  // namespace marey::pipeline::identify

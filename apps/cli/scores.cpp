#include "scores.h"

#include <fmt/core.h>

#include "json_value.h"

namespace marey::cli {

std::string percent(std::optional<double> fraction) {
  return fraction ? fmt::format("{:.1f} %", 100 * *fraction) : "none";
}

Json or_null(std::optional<double> value) {
  return value ? Json(*value) : Json();
}

Json as_json(const evaluate::Evaluation& scores) {
  const evaluate::ClearScores& clear = scores.clear;
  return {{"frames", scores.frames},
          {"common_frames", scores.common_frames},
          {"objects", scores.objects},
          {"tracks", scores.tracks},
          {"matches", clear.matches},
          {"mota", or_null(clear.mota)},
          {"motp", or_null(clear.motp)},
          {"recall", or_null(clear.recall)},
          {"precision", or_null(clear.precision)},
          {"fp", clear.false_positives},
          {"fn", clear.misses},
          {"idsw", clear.switches},
          {"frag", clear.fragmentations},
          {"mt", clear.mostly_tracked},
          {"pt", clear.partially_tracked},
          {"ml", clear.mostly_lost},
          {"idf1", or_null(scores.identity.f1)},
          {"idp", or_null(scores.identity.precision)},
          {"idr", or_null(scores.identity.recall)},
          {"idtp", scores.identity.true_positives},
          {"idfp", scores.identity.false_positives},
          {"idfn", scores.identity.false_negatives},
          {"hota", scores.hota.hota},
          {"deta", scores.hota.detection},
          {"assa", scores.hota.association},
          {"loca", scores.hota.localisation}};
}

}  // namespace marey::cli

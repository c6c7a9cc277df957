#include "edit_json.h"

#include <utility>

namespace marey::cli {

Json edit_json(const pipeline::take::EditLine& line) {
  Json entry{{"id", line.id}, {"operation", line.operation}, {"description", line.words}};
  if (line.parent) entry["parent"] = *line.parent;
  if (line.gaps.empty()) return entry;
  Json gaps = Json::array();
  for (const pipeline::take::EditLine::Gap& gap : line.gaps) {
    gaps.push_back({{"track", gap.track},
                    {"first", gap.frames.first},
                    {"last", gap.frames.last},
                    {"method", edit::name_of(gap.method)},
                    {"expected_mm", gap.expected_m * 1e3}});
  }
  entry["gaps"] = std::move(gaps);
  return entry;
}

}  // namespace marey::cli

// In place of gige.cpp where Aravis is not installed.
#include "marey/source/live/gige.h"

namespace marey::source::live {

std::optional<Kind> gige_kind() {
  return std::nullopt;
}

std::vector<FoundCamera> find_gige() {
  return {};
}

}  // namespace marey::source::live

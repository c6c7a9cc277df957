#include "marey/pipeline/markers/set_check.h"

#include <vector>

#include "marey/geometry/median.h"
#include "marey/pipeline/markers/labels_in_space.h"

namespace marey::pipeline::markers {
namespace {

constexpr std::size_t kMinSearches = 2;  // that found labels, before a misfit is reported during a run

}  // namespace

void SetCheck::add(const solve::labels::FoundNames& found) {
  for (std::size_t label = 0; label < decided_.size(); ++label) {
    decided_[label] = decided_[label] || (found.decided[label] && !found.undecided[label]);
    undecided_[label] = !decided_[label] && (undecided_[label] || found.undecided[label]);
  }
  misfits_.push_back(found.misfit);
  misfits_m_.push_back(found.misfit_m);
}

std::optional<std::string> SetCheck::misfit(std::size_t found, std::size_t markers) const {
  return set_misfit("the set", geometry::median(std::vector(misfits_)), geometry::median(std::vector(misfits_m_)), found, markers);
}

std::optional<std::string> SetCheck::new_misfit(std::size_t found, std::size_t markers) {
  if (reported_ || misfits_.size() < kMinSearches) return std::nullopt;
  auto message_text = misfit(found, markers);
  reported_ = message_text.has_value();
  return message_text;
}

}  // namespace marey::pipeline::markers

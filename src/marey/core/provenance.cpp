#include "marey/core/provenance.h"

#include <algorithm>

namespace marey {

std::optional<Provenance> provenance_of(std::string_view name) {
  if (name == "observed") return Provenance::measured;
  const auto found = std::find(kProvenanceNames.begin(), kProvenanceNames.end(), name);
  if (found == kProvenanceNames.end()) return std::nullopt;
  return static_cast<Provenance>(found - kProvenanceNames.begin());
}

}  // namespace marey

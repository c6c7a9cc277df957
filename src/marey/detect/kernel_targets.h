// The levels of the processor that inner loops are compiled for, by Google Highway (hwy/foreach_target.h): one source each for the
// background model and the markers, which chooses its table of functions when the program runs. To be included before any header of
// Highway.
#pragma once

// On x86 there are AVX3 (AVX-512), AVX2 and what the compiler makes of the loops with SSE2, which Highway calls SCALAR: the others
// have nothing for these loops that those lack.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

#include <cstdint>
#include <utility>
#include <vector>

#include <hwy/targets.h>

namespace marey::detect {

/// What `choose` gives at each level that this machine runs, by the level's name, the best first.
template <typename Table>
std::vector<std::pair<const char*, const Table*>> kernels_of_every_target(const Table& (*choose)()) {
  std::vector<std::pair<const char*, const Table*>> tables;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    tables.emplace_back(hwy::TargetName(target), &choose());
  }
  hwy::SetSupportedTargetsForTest(0);
  return tables;
}

}  // namespace marey::detect

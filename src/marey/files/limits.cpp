#include "marey/files/limits.h"

#include <array>

namespace marey {
namespace {

Limits& process_wide() {
  static Limits limits;
  return limits;
}

constexpr std::array<NamedLimit, 5> kLimits{{
    {"label_bytes", "bytes of a name", &Limits::label_bytes},
    {"tracks", "tracks of a recording", &Limits::tracks},
    {"pairs_a_frame", "pairs of a frame that are compared", &Limits::pairs_a_frame},
    {"observations", "blobs of all cameras at an instant", &Limits::observations},
    {"picture_px", "pixels of an image", &Limits::image_px},
}};
static_assert(kLimits.size() * sizeof(std::size_t) == sizeof(Limits), "a limit has no name");

}  // namespace

const Limits& Limits::in_force() {
  return process_wide();
}

void Limits::put_in_force(const Limits& limits) {
  process_wide() = limits;
}

std::span<const NamedLimit> all_limits() {
  return kLimits;
}

}  // namespace marey

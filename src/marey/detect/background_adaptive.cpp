#include "marey/detect/background_adaptive.h"

#include "marey/detect/background_opencv.h"

namespace marey {

std::unique_ptr<Background> make_adaptive(const AdaptiveOptions& /*options*/) {
  return make_mog2({});
}

}  // namespace marey

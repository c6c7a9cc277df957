#pragma once

#include <memory>

#include "marey/detect/background.h"

namespace marey {

std::unique_ptr<Background> make_adaptive(const AdaptiveOptions& options);

}  // namespace marey

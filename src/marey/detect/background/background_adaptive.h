#pragma once

#include <memory>

#include "marey/detect/background/background.h"

namespace marey::detect::background {

/// Marey's own model; background_adaptive.cpp explains it. Its results do not depend on the number of threads: it uses one.
std::unique_ptr<Background> make_adaptive(const AdaptiveOptions& options);

}  // namespace marey::detect::background

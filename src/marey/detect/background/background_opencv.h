#pragma once

#include <memory>

#include "marey/detect/background/background.h"

namespace marey::detect::background {

/// OpenCV's models behind the same door, so that Marey's own can be compared with them. They ignore `held`.
std::unique_ptr<Background> make_mog2(const Mog2Options& options);
std::unique_ptr<Background> make_knn(const KnnOptions& options);

}  // namespace marey::detect::background

#include "marey/detect/background/background.h"

#include <optional>
#include <type_traits>
#include <utility>

#include "marey/core/error.h"
#include "marey/detect/background/background_adaptive.h"
#include "marey/detect/background/background_opencv.h"

namespace marey::detect::background {
namespace {

std::unique_ptr<Background> make(const AdaptiveOptions& options) {
  return make_adaptive(options);
}
std::unique_ptr<Background> make(const Mog2Options& options) {
  return make_mog2(options);
}
std::unique_ptr<Background> make(const KnnOptions& options) {
  return make_knn(options);
}

/// Calls `visit` with the default options of every model, in the order of the register.
template <typename Visit>
void for_each_model(Visit&& visit) {
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (visit(std::variant_alternative_t<I, BackgroundOptions>{}), ...);
  }(std::make_index_sequence<std::variant_size_v<BackgroundOptions>>{});
}

}  // namespace

std::unique_ptr<Background> make_background(const BackgroundOptions& options) {
  return std::visit([](const auto& chosen) { return make(chosen); }, options);
}

std::string background_names() {
  std::string names;
  for_each_model([&](const auto& model) {
    if (!names.empty()) names += ", ";
    names += model.name;
  });
  return names;
}

BackgroundOptions parse_background(std::string_view name) {
  std::optional<BackgroundOptions> found;
  for_each_model([&](const auto& model) {
    if (model.name == name) found = model;
  });
  if (!found) throw Error("there is no background model \"{}\"; choose one of: {}", name, background_names());
  return *found;
}

}  // namespace marey::detect::background

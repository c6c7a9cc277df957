#include "marey/geometry/lens.h"

#include <utility>

namespace marey::geometry {
namespace {

constexpr std::size_t kModels = std::variant_size_v<Lens>;

template <std::size_t... I>
constexpr std::array<std::string_view, kModels> names_of(std::index_sequence<I...>) {
  return {std::variant_alternative_t<I, Lens>::name...};
}

template <std::size_t... I>
std::array<Lens, kModels> models_of(std::index_sequence<I...>) {
  return {std::variant_alternative_t<I, Lens>{}...};
}

constexpr std::array<std::string_view, kModels> kNames = names_of(std::make_index_sequence<kModels>());

}  // namespace

std::span<const std::string_view> lens_names() {
  return kNames;
}

std::optional<Lens> lens_named(std::string_view name) {
  for (const Lens& lens : models_of(std::make_index_sequence<kModels>())) {
    if (name_of(lens) == name) return lens;
  }
  return std::nullopt;
}

int coefficients_of(const Lens& lens) {
  return std::visit([](const auto& model) { return model.coefficients; }, lens);
}

bool ahead_only(const Lens& lens) {
  return std::visit([](const auto& model) { return model.ahead_only; }, lens);
}

std::string_view name_of(const Lens& lens) {
  return std::visit([](const auto& model) { return std::string_view(model.name); }, lens);
}

const Vector<2>& focal_of(const Lens& lens) {
  return std::visit([](const auto& model) -> const Vector<2>& { return model.focal; }, lens);
}

const Vector<2>& principal_of(const Lens& lens) {
  return std::visit([](const auto& model) -> const Vector<2>& { return model.principal; }, lens);
}

Lens scaled(const Lens& lens, double factor) {
  return std::visit(
      [factor](auto model) -> Lens {
        model.focal *= factor;
        model.principal = (model.principal.array() + 0.5) * factor - 0.5;
        return model;
      },
      lens);
}

}  // namespace marey::geometry

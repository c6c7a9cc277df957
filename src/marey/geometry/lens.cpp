#include "marey/geometry/lens.h"

namespace marey::geometry {

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

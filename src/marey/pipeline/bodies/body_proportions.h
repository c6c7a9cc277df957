// What height, mass and legs of a person say of each other.
#pragma once

namespace marey::pipeline::bodies {

/// kg/m²
inline double body_mass_index(double mass_kg, double height_m) {
  return mass_kg / (height_m * height_m);
}

/// physical: not beyond what living people have been reported with.
inline bool is_persons_index(double index) {
  return index >= 7 && index <= 110;
}

/// m, of one whose thigh and shank together are as long (Drillis & Contini 1966: 0.245 and 0.246 of the height).
inline double height_of_legs(double thigh_and_shank_m) {
  return thigh_and_shank_m / 0.491;
}

}  // namespace marey::pipeline::bodies

// An OpenSim model fitted to a person: the model's own text with its bodies scaled, its markers moved, its masses scaled.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/skeleton.h"

namespace marey::format::skeleton {

struct ScaledOsim {
  std::string text;
  std::vector<std::string> warnings;  ///< what could not follow the scales
};

/// `text` is the model, `fitted` the skeleton that was made of it: segments larger by `scales` along their own axes (solve's
/// `scaled` has the same rules), markers where the person has them. Frames of joints, shifts of CustomJoints, markers, points of
/// muscles' paths, wrapping surfaces, meshes and masses follow. Masses grow with their bodies' volumes, all alike to `mass_kg`
/// where it is given; inertias are those of the stretched bodies. Throws Error if `fitted` is not of this model.
ScaledOsim scaled_osim(std::string_view text, const std::string& name, const Skeleton& fitted, std::span<const Vector<3>> scales,
                       const std::optional<double>& mass_kg = {});

}  // namespace marey::format::skeleton

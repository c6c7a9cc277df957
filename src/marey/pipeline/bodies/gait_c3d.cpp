#include "marey/pipeline/bodies/gait_c3d.h"

#include <algorithm>
#include <array>
#include <numbers>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "marey/format/recording_file.h"
#include "marey/format/register.h"

namespace marey::pipeline::bodies {
namespace {

struct Triple {
  std::string_view ours, theirs;
  std::string_view second = {};  ///< what the second of the three is called where it is written with the other sign
};

/// Our joints and the names of Plug-in Gait's outputs. Its spine, shoulders and wrists turn about other axes than the ISB's: those
/// have names of their own. Its ankle's second angle grows to the other side.
constexpr std::array<Triple, 10> kTriples = {{{"pelvis", "PelvisAngles"},
                                              {"trunk", "ThoraxAngles"},
                                              {"spine", "SpineAnglesISB"},
                                              {"hip", "HipAngles"},
                                              {"knee", "KneeAngles"},
                                              {"ankle", "AnkleAngles", "eversion"},
                                              {"foot", "FootAngles"},
                                              {"shoulder", "ShoulderAnglesISB"},
                                              {"elbow", "ElbowAngles"},
                                              {"wrist", "WristAnglesISB"}}};

/// Three curves as one; a row in which one of them is not known is not one.
format::AngleTriple triple_of(std::string label, std::span<const analyse::gait::AngleCurve> curves, const Triple& of,
                              std::size_t prefix) {
  format::AngleTriple triple{.label = std::move(label), .description = {}, .rows = {}};
  for (std::size_t i = 0; i < 3; ++i) {
    std::string name = i == 1 && !of.second.empty() ? std::string(of.second) : curves[i].name.substr(prefix);
    std::replace(name.begin(), name.end(), '_', ' ');
    triple.description += (i == 0 ? "" : ", ") + name;
  }
  const Vector<3> degrees = Vector<3>(1, of.second.empty() ? 1 : -1, 1) * 180 / std::numbers::pi;
  for (std::size_t r = 0; r < curves[0].values.size(); ++r) {
    if (!curves[0].values[r] || !curves[1].values[r] || !curves[2].values[r]) {
      triple.rows.emplace_back();
    } else {
      const Vector<3> rotations(*curves[0].values[r], *curves[1].values[r], *curves[2].values[r]);
      triple.rows.emplace_back(rotations.cwiseProduct(degrees));
    }
  }
  return triple;
}

bool any_row(const format::AngleTriple& triple) {
  return std::any_of(triple.rows.begin(), triple.rows.end(), [](const auto& row) { return row.has_value(); });
}

}  // namespace

format::MotionFindings findings_of(const GaitMeasure& measure) {
  format::MotionFindings found;
  // Three curves of a joint stand together in the order of `angle_names`.
  for (std::size_t a = 0; a + 3 <= measure.angles.size(); a += 3) {
    const std::string& name = measure.angles[a].name;
    const bool left = name.starts_with("left_");
    const std::string_view joint = std::string_view(name).substr(left ? 5 : 6);
    for (const Triple& of : kTriples) {
      if (!joint.starts_with(of.ours)) continue;
      format::AngleTriple triple = triple_of(fmt::format("{}{}", left ? 'L' : 'R', of.theirs),
                                             std::span(measure.angles).subspan(a, 3), of, (left ? 6 : 7) + of.ours.size());
      if (any_row(triple)) found.angles.push_back(std::move(triple));
    }
  }
  for (const analyse::gait::GaitEvent& event : measure.events)
    found.events.push_back({event.side == analyse::gait::Side::left ? "Left" : "Right", event.strike ? "Foot Strike" : "Foot Off",
                            static_cast<double>(measure.first_index) / measure.rate_hz + event.time_s});
  return found;
}

void write_gait_c3d(const std::string& path, const std::string& recording, const std::optional<format::UpAxis>& up,
                    const GaitMeasure& measure) {
  const format::Format& format = format::format_to_write(path, "c3d", format::Content::space);
  format::ReadOptions how;
  how.up = up;
  format::WritePlan plan = format::plan_of(*format::open_recording(recording, how), recording);
  plan.up = format::up_axis(plan.info, up);
  plan.found = findings_of(measure);
  replay(*format::open_recording(recording, how), *format::create_recording(path, format, plan));
}

}  // namespace marey::pipeline::bodies

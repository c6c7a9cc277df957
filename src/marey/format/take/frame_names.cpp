#include "marey/format/take/frame_names.h"

#include <array>
#include <utility>

namespace marey::format::take {
namespace {

constexpr std::array<std::pair<FrameOfReference::Kind, std::string_view>, 4> kNames{
    {{FrameOfReference::Kind::image, "image"},
     {FrameOfReference::Kind::ground, "ground"},
     {FrameOfReference::Kind::user_ground, "user_ground"},
     {FrameOfReference::Kind::space, "space"}}};

}  // namespace

std::string_view name_of(FrameOfReference::Kind kind) {
  for (const auto& [each, name] : kNames) {
    if (each == kind) return name;
  }
  return {};
}

std::optional<FrameOfReference::Kind> frame_kind_of(std::string_view name) {
  for (const auto& [kind, each] : kNames) {
    if (each == name) return kind;
  }
  return std::nullopt;
}

}  // namespace marey::format::take

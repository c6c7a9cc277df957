#include "marey/format/skeleton/skeleton_file.h"

#include "marey/core/error.h"
#include "marey/format/read_file.h"

namespace marey::format::skeleton {

Matrix<3> z_up_from(UpAxis up) {
  Matrix<3> turn = Matrix<3>::Identity();
  if (up == UpAxis::y) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

namespace {

/// A pose costs as the cube of their number; OpenSim's largest models have some 200.
constexpr std::size_t kMaxCoordinates = 1000;

SkeletonFile read_any(const std::string& path, const SkeletonOptions& options) {
  const Beginning beginning = beginning_of(path);
  if (beginning.folder) throw Error("{}: is a folder; a skeleton's file is wanted", path);
  std::string text = read_file(path);
  const auto first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  const std::string_view from_first = first == std::string::npos ? std::string_view() : std::string_view(text).substr(first);
  if (from_first.starts_with("HIERARCHY")) return parse_bvh(text, path, options);
  if (from_first.starts_with('<') && text.find("<KinematicModel") != std::string::npos) return parse_vsk(text, path, options);
  if (from_first.starts_with('<')) return parse_osim(text, path);
  if (text.find(":bonedata") != std::string::npos) return parse_asf(text, path, options);
  if (text.find('\0') == std::string::npos && text.find("[[segment]]") != std::string::npos) return parse_toml(text, path);
  throw Error(
      "{}: is not a skeleton that Marey knows: OpenSim's .osim, Vicon's .vsk, .bvh, .asf, or a skeleton.toml with [[segment]] "
      "tables",
      path);
}

}  // namespace

SkeletonFile read_skeleton(const std::string& path, const SkeletonOptions& options) {
  SkeletonFile file = read_any(path, options);
  if (const std::size_t count = file.skeleton.coordinates.size(); count > kMaxCoordinates)
    throw Error("{}: has {} coordinates; at most {} are solved", path, count, kMaxCoordinates);
  return file;
}

}  // namespace marey::format::skeleton

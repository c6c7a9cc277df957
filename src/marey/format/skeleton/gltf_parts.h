// What a glTF file is made of: its one buffer of numbers, and small meshes. glTF 2.0, sections 3.6 and 3.7.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/geometry.h"

namespace marey::format::skeleton {

/// The buffer, and what says where in it everything lies.
class GltfBuffer {
 public:
  /// Appends numbers as one accessor and returns its index. `bounds`: says the least and the greatest of each component.
  template <typename T>
  int add(const std::vector<T>& values, int component, const char* type, std::size_t width, bool bounds, int target = 0) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    views_.push_back(fmt::format("{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}{}}}", bytes_.size(), values.size() * sizeof(T),
                                 target != 0 ? fmt::format(",\"target\":{}", target) : ""));
    bytes_.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    accessors_.push_back(fmt::format("{{\"bufferView\":{},\"componentType\":{},\"count\":{},\"type\":\"{}\"{}}}", views_.size() - 1,
                                     component, values.size() / width, type, bounds ? bounds_of(values, width) : ""));
    return static_cast<int>(accessors_.size()) - 1;
  }

  /// When it is padded to whole words.
  std::size_t size() const { return (bytes_.size() + 3) / 4 * 4; }
  const std::vector<std::string>& views() const { return views_; }
  const std::vector<std::string>& accessors() const { return accessors_; }
  std::string take_bytes() {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    return std::move(bytes_);
  }

 private:
  template <typename T>
  static std::string bounds_of(const std::vector<T>& values, std::size_t width) {
    std::vector<T> minimum(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(width)), greatest = minimum;
    for (std::size_t i = 0; i < values.size(); ++i) {
      minimum[i % width] = std::min(minimum[i % width], values[i]);
      greatest[i % width] = std::max(greatest[i % width], values[i]);
    }
    return fmt::format(",\"min\":[{}],\"max\":[{}]", fmt::join(minimum, ","), fmt::join(greatest, ","));
  }

  std::string bytes_;
  std::vector<std::string> views_, accessors_;
};

/// Appends x, y, z.
inline void push_vector(std::vector<float>& values, const Vector<3>& v) {
  for (int i = 0; i < 3; ++i) values.push_back(static_cast<float>(v[i]));
}

/// Vertices of octahedra: bones of the stick figure, all of a bone bound to its segment, or a marker.
struct Octahedra {
  static constexpr double kMinBone = 1e-3;  ///< m; shorter ones are not drawn

  std::vector<float> positions, normals, weights;
  std::vector<std::uint16_t> joints;
  std::vector<std::uint32_t> indices;

  /// An octahedron, thickest at a fifth of the bone; eight faces with corners of their own, so that they appear flat.
  void add_bone(const Vector<3>& from, const Vector<3>& to, std::size_t joint) {
    const Vector<3> along = to - from;
    const double length = along.norm();
    if (!(length > kMinBone)) return;
    const Vector<3> direction = along / length, side = direction.unitOrthogonal() * 0.12 * length, other = direction.cross(side);
    add_octahedron(from, to, from + 0.2 * along, side, other, joint);
  }

  /// A regular octahedron about the origin.
  void add_marker(double radius_m) {
    const Vector<3> up = Vector<3>::UnitY() * radius_m;
    add_octahedron(-up, up, Vector<3>::Zero(), Vector<3>::UnitX() * radius_m, -Vector<3>::UnitZ() * radius_m, 0);
  }

 private:
  void add_octahedron(const Vector<3>& from, const Vector<3>& to, const Vector<3>& middle, const Vector<3>& side,
                      const Vector<3>& other, std::size_t joint) {
    const std::array<Vector<3>, 4> ring = {middle + side, middle + other, middle - side, middle - other};
    for (std::size_t i = 0; i < 4; ++i) {
      add_face(from, ring[(i + 1) % 4], ring[i], joint);
      add_face(to, ring[i], ring[(i + 1) % 4], joint);
    }
  }

  void add_face(const Vector<3>& a, const Vector<3>& b, const Vector<3>& c, std::size_t joint) {
    const Vector<3> normal = (b - a).cross(c - a).normalized();
    for (const Vector<3>* corner : {&a, &b, &c}) {
      indices.push_back(static_cast<std::uint32_t>(indices.size()));
      push_vector(positions, *corner);
      push_vector(normals, normal);
      joints.insert(joints.end(), {static_cast<std::uint16_t>(joint), 0, 0, 0});
      weights.insert(weights.end(), {1, 0, 0, 0});
    }
  }
};

}  // namespace marey::format::skeleton

// MATLAB's MAT-files of level 5, as much of them as motion capture exports: numbers, texts, cells and structures, compressed or
// not. Reference: MathWorks, "MAT-File Format", level 5. Files of version 7.3 are HDF5, and refused with the hint.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace marey::format::motion {

/// A variable, a field, or a cell.
struct MatValue {
  std::string name;
  std::vector<std::size_t> dimensions;
  std::vector<double> numbers;     ///< of a numeric array, the first index fastest
  std::string text;                ///< of characters
  std::vector<MatValue> children;  ///< of a cell its elements; of a structure of 1x1 its fields

  /// The field of that name; null if there is none.
  const MatValue* field(std::string_view field_name) const;
  /// "Trajectories.Labeled.Data"
  const MatValue* at(std::string_view path) const;
};

/// The variables of a file. Throws Error, with `name` for the file, for what is not such a file or is damaged.
std::vector<MatValue> read_mat(std::string_view bytes, const std::string& name);

}  // namespace marey::format::motion

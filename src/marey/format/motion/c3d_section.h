#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "marey/format/motion/c3d_parameters.h"

namespace marey::format::motion {

constexpr std::size_t kC3dMaxNames = 255;  // in one parameter: its dimensions are bytes

/// A PC's numbers, least byte first.
void put_byte(std::string& bytes, std::size_t value);
void put_word(std::string& bytes, std::int64_t value);
void put_real(std::string& bytes, double value);

/// The section of parameters of a C3D file, built up group by group.
class C3dSection {
 public:
  void group(const std::string& name);
  void word(const std::string& name, std::int64_t value);
  void words(const std::string& name, std::span<const std::int64_t> values);
  void real(const std::string& name, double value);
  /// By the first of `dimensions` first, as all of C3D is.
  void reals(const std::string& name, std::span<const double> values, const std::vector<std::size_t>& dimensions);
  void text(const std::string& name, const std::string& text);
  /// All of the width of the longest. More than 255 continue in NAME2, NAME3, …
  void texts(const std::string& name, std::span<const std::string> texts);
  /// As it was read.
  void copy(const C3dParameter& parameter);
  /// Whole blocks. Throws Error if it is longer than the format allows.
  std::string blocks(const std::string& path) const;

 private:
  void parameter(const std::string& name, int type, std::span<const std::size_t> dimensions, const std::string& data);

  std::string bytes_;
  int group_ = 0;
};

}  // namespace marey::format::motion

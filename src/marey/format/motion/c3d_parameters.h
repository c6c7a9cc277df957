#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace marey::format::motion {

/// Bytes; the head is one, and what follows begins at a multiple.
constexpr std::size_t kC3dBlock = 512;

/// Whose numbers a C3D file holds: Intel's (PC), DEC's (VAX: floats of their own, words swapped), SGI's (MIPS: big-endian).
enum class C3dProcessor : std::uint8_t { intel = 84, dec = 85, sgi = 86 };

/// A C3D file's bytes, read as one of three processors would. Offsets must lie within the file.
class C3dBytes {
 public:
  C3dBytes(std::span<const std::byte> bytes, C3dProcessor processor) : bytes_(bytes), processor_(processor) {}

  std::size_t size() const { return bytes_.size(); }
  std::uint8_t byte(std::size_t at) const { return std::to_integer<std::uint8_t>(bytes_[at]); }
  std::uint16_t word(std::size_t at) const {
    const auto a = byte(at), b = byte(at + 1);
    return static_cast<std::uint16_t>(processor_ == C3dProcessor::sgi ? a << 8 | b : b << 8 | a);
  }
  std::int16_t integer(std::size_t at) const { return static_cast<std::int16_t>(word(at)); }
  float real(std::size_t at) const;
  std::string_view text(std::size_t at, std::size_t length) const {
    return {reinterpret_cast<const char*>(bytes_.data()) + at, length};
  }

 private:
  std::span<const std::byte> bytes_;
  C3dProcessor processor_;
};

/// One parameter: texts, or numbers in the order they lie in the file.
struct C3dParameter {
  std::vector<std::string> texts;  ///< trimmed
  std::vector<double> numbers;
  std::string name = {};                     ///< as it is written there, without its group
  int type = -1;                             ///< −1 texts, 1 bytes, 2 words, 4 reals
  std::vector<std::size_t> dimensions = {};  ///< of texts their width is the first
};

/// A C3D file's first block and its parameters.
struct C3dHead {
  C3dProcessor processor = C3dProcessor::intel;
  // The first block
  std::uint16_t points = 0, analog_words = 0, first_frame = 0, last_frame = 0, data_block = 0, analog_samples = 0;
  float scale = 0, rate_hz = 0;
  std::map<std::string, C3dParameter, std::less<>> parameters;  ///< by "GROUP:NAME", in capitals
  std::vector<std::string> warnings;

  /// Nothing if it is missing, or is text.
  std::optional<double> number(std::string_view name, std::size_t index = 0) const;
  std::string text(std::string_view name) const;
  /// Of a parameter that continues in others of its name, with a number behind it.
  std::vector<std::string> texts(std::string_view name) const;
  std::vector<double> numbers(std::string_view name) const;
};

/// Throws Error, with `name` for the file, where the bytes are not C3D file's.
C3dHead read_c3d_head(std::span<const std::byte> bytes, const std::string& name);

}  // namespace marey::format::motion

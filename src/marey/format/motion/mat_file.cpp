#include "marey/format/motion/mat_file.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

#include "marey/core/error.h"
#include "marey/files/inflate.h"
#include "marey/files/text_safety.h"

namespace marey::format::motion {
namespace {

constexpr std::size_t kMatHead = 128, kMaxMatDepth = 16, kMaxMatDimensions = 8;  // format
constexpr std::size_t kMaxMatBytes = std::size_t{2} << 30;                       // format: a size has 31 bits
constexpr std::uint32_t kMatMatrix = 14, kMatCompressed = 15;                    // format
constexpr std::uint32_t kMatCell = 1, kMatStructure = 2, kMatCharacters = 4;     // format

struct MatElement {
  std::uint32_t type = 0;
  std::string_view bytes;
};

class MatBytes {
 public:
  MatBytes(std::string_view bytes, bool swapped, const std::string& name) : bytes_(bytes), swapped_(swapped), name_(name) {}

  bool ended() const { return bytes_.size() < 8; }

  /// The next element, padded to eight bytes but if it is compressed.
  MatElement next() {
    if (bytes_.size() < 8) fail();
    const std::uint32_t first = word(0);
    if (first >> 16U != 0) {  // a small one: size and type in one word, the data in the next
      const std::size_t size = first >> 16U;
      if (size > 4) fail();
      const MatElement element{first & 0xFFFFU, bytes_.substr(4, size)};
      bytes_.remove_prefix(8);
      return element;
    }
    const std::size_t size = word(4);
    if (size > bytes_.size() - 8) fail();
    const MatElement element{first, bytes_.substr(8, size)};
    const std::size_t padded = first == kMatCompressed ? size : (size + 7) / 8 * 8;
    bytes_.remove_prefix(std::min(8 + padded, bytes_.size()));
    return element;
  }

  /// Of any of the numeric types.
  std::vector<double> numbers(const MatElement& element) const {
    switch (element.type) {
      case 1:
        return all<std::int8_t>(element);
      case 2:
      case 16:  // UTF-8
        return all<std::uint8_t>(element);
      case 3:
        return all<std::int16_t>(element);
      case 4:
      case 17:  // UTF-16
        return all<std::uint16_t>(element);
      case 5:
        return all<std::int32_t>(element);
      case 6:
        return all<std::uint32_t>(element);
      case 7:
        return all<float>(element);
      case 9:
        return all<double>(element);
      case 12:
        return all<std::int64_t>(element);
      case 13:
        return all<std::uint64_t>(element);
      default:
        fail();
    }
  }

  MatBytes part(std::string_view bytes) const { return {bytes, swapped_, name_}; }
  const std::string& name() const { return name_; }
  [[noreturn]] void fail() const { throw Error("{}: is a damaged MAT-file, or cut off", name_); }

 private:
  std::uint32_t word(std::size_t at) const { return value<std::uint32_t>(bytes_.data() + at); }

  template <typename T>
  T value(const char* from) const {
    std::array<char, sizeof(T)> raw{};
    std::memcpy(raw.data(), from, sizeof(T));
    if (swapped_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

  template <typename T>
  std::vector<double> all(const MatElement& element) const {
    std::vector<double> values;
    values.reserve(element.bytes.size() / sizeof(T));
    for (std::size_t at = 0; at + sizeof(T) <= element.bytes.size(); at += sizeof(T))
      values.push_back(static_cast<double>(value<T>(element.bytes.data() + at)));
    return values;
  }

  std::string_view bytes_;
  bool swapped_;
  const std::string& name_;
};

MatValue read_matrix(MatBytes bytes, std::size_t depth);

std::size_t count_of(const std::vector<std::size_t>& dimensions, const MatBytes& bytes) {
  std::size_t count = 1;
  for (const std::size_t n : dimensions) {
    if (n != 0 && count > kMaxMatBytes / n) bytes.fail();
    count *= n;
  }
  return count;
}

/// Cells, or the fields of a structure; an array of structures is read as its first one's fields.
std::vector<MatValue> read_children(MatBytes& bytes, const std::vector<std::string>& names, std::size_t count, std::size_t depth) {
  std::vector<MatValue> children;
  const std::size_t wanted = names.empty() ? count : names.size();
  for (std::size_t i = 0; i < wanted && !bytes.ended(); ++i) {
    const MatElement element = bytes.next();
    if (element.type != kMatMatrix) bytes.fail();
    MatValue child = element.bytes.empty() ? MatValue() : read_matrix(bytes.part(element.bytes), depth + 1);
    if (!names.empty()) child.name = names[i];
    children.push_back(std::move(child));
  }
  return children;
}

std::vector<std::string> field_names(MatBytes& bytes) {
  const std::vector<double> length = bytes.numbers(bytes.next());
  const std::string_view text = bytes.next().bytes;
  if (length.size() != 1 || !(length[0] >= 1 && length[0] <= 4096)) bytes.fail();
  std::vector<std::string> names;
  for (std::size_t at = 0; at < text.size(); at += static_cast<std::size_t>(length[0])) {
    const std::string_view padded = text.substr(at, static_cast<std::size_t>(length[0]));
    names.push_back(plain_text(padded.substr(0, padded.find('\0'))));
  }
  return names;
}

MatValue read_matrix(MatBytes bytes, std::size_t depth) {
  if (depth > kMaxMatDepth) bytes.fail();
  const std::vector<double> flags = bytes.numbers(bytes.next());
  if (flags.empty()) bytes.fail();
  const std::uint32_t kind = static_cast<std::uint32_t>(flags[0]) & 0xFFU;
  MatValue value;
  const std::vector<double> dimensions = bytes.numbers(bytes.next());
  if (dimensions.size() > kMaxMatDimensions) bytes.fail();
  for (const double n : dimensions) {
    if (!(n >= 0 && n < 2147483648.0)) bytes.fail();
    value.dimensions.push_back(static_cast<std::size_t>(n));
  }
  const std::size_t count = count_of(value.dimensions, bytes);
  value.name = plain_text(bytes.next().bytes);
  if (kind == kMatCell) {
    value.children = read_children(bytes, {}, count, depth);
  } else if (kind == kMatStructure) {
    const std::vector<std::string> names = field_names(bytes);
    if (count > 0 && !names.empty()) value.children = read_children(bytes, names, count, depth);
  } else if (!bytes.ended() && kind >= kMatCharacters && kind <= 15) {
    std::vector<double> numbers = bytes.numbers(bytes.next());
    if (numbers.size() < count && kind != kMatCharacters) bytes.fail();
    if (kind == kMatCharacters) {
      for (const double c : numbers) value.text += c >= 32 && c < 127 ? static_cast<char>(c) : '?';
    } else {
      value.numbers = std::move(numbers);
    }
  }
  return value;
}

}  // namespace

const MatValue* MatValue::field(std::string_view field_name) const {
  const auto found =
      std::find_if(children.begin(), children.end(), [&](const MatValue& child) { return child.name == field_name; });
  return found == children.end() ? nullptr : &*found;
}

const MatValue* MatValue::at(std::string_view path) const {
  const MatValue* value = this;
  while (value != nullptr && !path.empty()) {
    const std::string_view first = path.substr(0, path.find('.'));
    value = value->field(first);
    path.remove_prefix(std::min(first.size() + 1, path.size()));
  }
  return value;
}

std::vector<MatValue> read_mat(std::string_view bytes, const std::string& name) {
  if (bytes.starts_with("MATLAB 7.3")) throw Error("{}: is a MAT-file of version 7.3 (HDF5); save it as version 7 or older", name);
  if (!bytes.starts_with("MATLAB 5.0") || bytes.size() < kMatHead) throw Error("{}: is not a MAT-file of level 5", name);
  const std::string_view order = bytes.substr(126, 2);
  if (order != "IM" && order != "MI") throw Error("{}: is a damaged MAT-file, or cut off", name);
  const bool swapped = (order == "MI") == (std::endian::native == std::endian::little);
  std::vector<MatValue> variables;
  MatBytes all(bytes.substr(kMatHead), swapped, name);
  while (!all.ended()) {
    const MatElement element = all.next();
    if (element.type == kMatCompressed) {
      const std::string whole = inflated(element.bytes, kMaxMatBytes, name);
      MatBytes within = all.part(whole);
      const MatElement matrix = within.next();
      if (matrix.type == kMatMatrix && !matrix.bytes.empty()) variables.push_back(read_matrix(all.part(matrix.bytes), 0));
    } else if (element.type == kMatMatrix && !element.bytes.empty()) {
      variables.push_back(read_matrix(all.part(element.bytes), 0));
    }
  }
  return variables;
}

}  // namespace marey::format::motion

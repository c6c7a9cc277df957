// Numbers as wires carry them: in the byte order of the protocol, one after the other, without gaps.
#pragma once

#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace marey::stream {

/// A number's bytes, turned where the protocol's order is not this machine's.
template <std::endian order, typename T>
  requires std::integral<T> || std::floating_point<T>
std::array<char, sizeof(T)> bytes_of(T value) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), &value, sizeof(T));
  if constexpr (order != std::endian::native) {
    for (std::size_t i = 0; i < sizeof(T) / 2; ++i) std::swap(bytes[i], bytes[sizeof(T) - 1 - i]);
  }
  return bytes;
}

/// Values written one after the other. Widths are said at each call, so that no number goes out in another one than was meant.
template <std::endian order>
class BytesIn {
 public:
  template <typename T>
  BytesIn& put(std::type_identity_t<T> value) {
    const auto bytes = bytes_of<order, T>(value);
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  BytesIn& raw(std::string_view bytes) {
    text_.append(bytes);
    return *this;
  }
  /// With a NUL behind it.
  BytesIn& text(std::string_view text) {
    text_.append(text).push_back('\0');
    return *this;
  }
  /// Writes over what stands there already.
  template <typename T>
  void set(std::size_t at, std::type_identity_t<T> value) {
    const auto bytes = bytes_of<order, T>(value);
    text_.replace(at, bytes.size(), bytes.data(), bytes.size());
  }

  std::size_t size() const { return text_.size(); }
  const std::string& str() const& { return text_; }
  std::string str() && { return std::move(text_); }

 private:
  std::string text_;
};

using LittleBytes = BytesIn<std::endian::little>;
using BigBytes = BytesIn<std::endian::big>;

/// The number that stands at `at`; nothing if the bytes end before it does.
template <typename T, std::endian order = std::endian::little>
std::optional<T> number_at(std::string_view bytes, std::size_t at) {
  if (at > bytes.size() || bytes.size() - at < sizeof(T)) return std::nullopt;
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  const auto rotated = bytes_of<order, T>(value);
  std::memcpy(&value, rotated.data(), sizeof(T));
  return value;
}

}  // namespace marey::stream

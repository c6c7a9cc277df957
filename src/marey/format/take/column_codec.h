// Columns as bytes, little-endian, one number behind the other. What a blob holds follows from its length and the number of rows:
// float32 or float64, and whether a bitmap of the rows that are known comes first. Readers check that, so that no file can make
// them read beyond a blob.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"

namespace marey::format::take {

using Bytes = std::vector<std::byte>;

/// float32 where that loses nothing of any value, else float64.
void encode_exactly(std::span<const double> values, Bytes& blob);
/// float32, or as above. `blob` stays empty if no row is known.
void encode(const OptionalColumn& column, std::size_t rows, bool exactly, Bytes& blob);

template <typename Value>
void encode_unambiguously(std::span<const Value> values, Bytes& blob) {
  const auto bytes = std::as_bytes(values);
  blob.assign(bytes.begin(), bytes.end());
}

/// The value that all have, where they have one.
template <typename Value>
std::optional<Value> common_value(std::span<const Value> values) {
  for (const Value& value : values) {
    if (value != values.front()) return std::nullopt;
  }
  return values.empty() ? std::nullopt : std::optional<Value>(values.front());
}

/// Reads one row of a table; `where` names it in messages. All throw Error, "where: is damaged (…)", for a blob that is not one of
/// ours.
class ColumnDecoder {
 public:
  ColumnDecoder(std::size_t rows, std::string_view where) : rows_(rows), where_(where) {}

  std::size_t rows() const { return rows_; }
  /// Finite numbers, `rows` of them.
  void numbers(std::span<const std::byte> blob, std::vector<double>& values) const;
  /// Appends to `column`, whose rows begin at `first`. An empty blob: none is known.
  void optional(std::span<const std::byte> blob, std::size_t first, OptionalColumn& column);
  /// Unsigned integers of 1, 2, 4 or 8 bytes each, `rows` of them.
  void integers(std::span<const std::byte> blob, std::vector<std::uint64_t>& values) const;
  /// Growing places below `end`, from a blob of uint32.
  void locations(std::span<const std::byte> blob, std::size_t end, bool may_repeat, std::vector<std::int32_t>& values) const;

  [[noreturn]] void fail(std::string_view what) const;

 private:
  void finite(std::span<const std::byte> blob, std::size_t count, std::vector<double>& values) const;

  std::size_t rows_;
  std::string_view where_;
  std::vector<double> values_;
  std::vector<bool> known_;
};

/// As few bytes each as the largest needs.
void encode_integers(std::span<const std::uint64_t> values, Bytes& blob);

}  // namespace marey::format::take

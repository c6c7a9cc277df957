#include "marey/format/take/column_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "marey/core/error.h"

namespace marey::format::take {
namespace {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie in memory");

bool fits_float(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return static_cast<double>(static_cast<float>(value)) == value; });
}

template <typename Stored, typename Value>
void append_as(std::span<const Value> values, Bytes& blob) {
  const std::size_t begin = blob.size();
  blob.resize(begin + values.size() * sizeof(Stored));
  std::byte* out = blob.data() + begin;
  for (const Value& value : values) {
    const auto stored = static_cast<Stored>(value);
    std::memcpy(out, &stored, sizeof(Stored));
    out += sizeof(Stored);
  }
}

template <typename Stored, typename Value>
void read_as(std::span<const std::byte> blob, std::vector<Value>& values) {
  values.resize(blob.size() / sizeof(Stored));
  for (std::size_t i = 0; i < values.size(); ++i) {
    Stored stored;
    std::memcpy(&stored, blob.data() + i * sizeof(Stored), sizeof(Stored));
    values[i] = static_cast<Value>(stored);
  }
}

constexpr std::size_t bitmap_bytes(std::size_t rows) {
  return (rows + 7) / 8;
}

void append_bitmap(const OptionalColumn& column, std::size_t rows, Bytes& blob) {
  const std::size_t begin = blob.size();
  blob.resize(begin + bitmap_bytes(rows));
  for (std::size_t row = 0; row < rows; ++row) {
    if (column.known(row)) blob[begin + row / 8] |= std::byte{1} << (row % 8);
  }
}

}  // namespace

void encode_exactly(std::span<const double> values, Bytes& blob) {
  blob.clear();
  if (fits_float(values)) {
    append_as<float>(values, blob);
  } else {
    append_as<double>(values, blob);
  }
}

void encode(const OptionalColumn& column, std::size_t rows, bool exactly, Bytes& blob) {
  blob.clear();
  if (column.empty()) return;
  if (!column.all_known(rows)) append_bitmap(column, rows, blob);
  const std::size_t begin = blob.size();
  const bool wide = exactly && !fits_float(column.values());
  if (wide) {
    append_as<double>(column.values(), blob);
  } else {
    append_as<float>(column.values(), blob);
  }
  blob.resize(begin + rows * static_cast<std::size_t>(column.width()) * (wide ? 8 : 4));
}

void encode_integers(std::span<const std::uint64_t> values, Bytes& blob) {
  std::uint64_t all = 0;
  for (const std::uint64_t value : values) all |= value;
  blob.clear();
  if (all <= 0xff) {
    append_as<std::uint8_t>(values, blob);
  } else if (all <= 0xffff) {
    append_as<std::uint16_t>(values, blob);
  } else if (all <= 0xffffffff) {
    append_as<std::uint32_t>(values, blob);
  } else {
    append_as<std::uint64_t>(values, blob);
  }
}

void ColumnDecoder::fail(std::string_view what) const {
  throw Error("{}: is damaged ({}); restore it from a copy", where_, what);
}

void ColumnDecoder::finite(std::span<const std::byte> blob, std::size_t count, std::vector<double>& values) const {
  if (blob.size() == count * 4) {
    read_as<float>(blob, values);
  } else {
    read_as<double>(blob, values);
  }
  // Infinite and NaN stay so when they are multiplied by 0; nothing else becomes it.
  double sum = 0;
  for (const double value : values) sum += value * 0;
  if (sum != 0) fail("a number is infinite or none");
}

void ColumnDecoder::numbers(std::span<const std::byte> blob, std::vector<double>& values) const {
  if (blob.size() != rows_ * 4 && blob.size() != rows_ * 8) fail("a column has another length than its rows");
  finite(blob, rows_, values);
}

void ColumnDecoder::optional(std::span<const std::byte> blob, std::size_t first, OptionalColumn& column) {
  if (blob.empty()) return;
  const std::size_t count = rows_ * static_cast<std::size_t>(column.width());
  const std::size_t bitmap = bitmap_bytes(rows_);
  known_.clear();
  if (blob.size() == bitmap + count * 4 || blob.size() == bitmap + count * 8) {
    known_.resize(rows_);
    for (std::size_t row = 0; row < rows_; ++row) known_[row] = (blob[row / 8] >> (row % 8) & std::byte{1}) != std::byte{0};
    blob = blob.subspan(bitmap);
  } else if (blob.size() != count * 4 && blob.size() != count * 8) {
    fail("an optional column has another length than its rows");
  }
  finite(blob, count, values_);
  column.add_rows(first, values_, known_);
}

void ColumnDecoder::integers(std::span<const std::byte> blob, std::vector<std::uint64_t>& values) const {
  if (blob.size() == rows_) return read_as<std::uint8_t>(blob, values);
  if (blob.size() == rows_ * 2) return read_as<std::uint16_t>(blob, values);
  if (blob.size() == rows_ * 4) return read_as<std::uint32_t>(blob, values);
  if (blob.size() == rows_ * 8) return read_as<std::uint64_t>(blob, values);
  fail("a column has another length than its rows");
}

void ColumnDecoder::locations(std::span<const std::byte> blob, std::size_t end, bool may_repeat,
                              std::vector<std::int32_t>& values) const {
  if (blob.size() != rows_ * 4) fail("a column has another length than its rows");
  read_as<std::int32_t>(blob, values);
  std::int64_t next = 0;
  for (const std::int32_t value : values) {
    if (value < next || static_cast<std::size_t>(value) >= end) fail("rows are out of order");
    next = std::int64_t{value} + (may_repeat ? 0 : 1);
  }
}

}  // namespace marey::format::take

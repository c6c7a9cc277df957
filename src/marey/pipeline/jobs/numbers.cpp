#include "marey/pipeline/jobs/numbers.h"

#include <charconv>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace marey::pipeline::jobs {
namespace {

template <typename T>
std::optional<T> whole_text(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  T value{};
  const auto [stop, failed] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failed != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  return value;
}

/// 1000000 as 1e6.
std::string plain(double value) {
  std::string text = fmt::format("{:g}", value);
  if (const auto exponent = text.find("e+0"); exponent != std::string::npos) text.erase(exponent + 1, 2);
  return text;
}

}  // namespace

bool contains(const Interval& interval, double value) {
  return (interval.open_low ? value > interval.low : value >= interval.low) && value <= interval.high;
}

std::string notation(const Interval& interval) {
  return fmt::format("{}{}, {}]", interval.open_low ? '(' : '[', plain(interval.low), plain(interval.high));
}

std::string notation(std::int64_t low, std::int64_t high) {
  if (high == std::numeric_limits<std::int64_t>::max()) return fmt::format("[{}, 2^63 - 1]", low);
  return fmt::format("[{}, {}]", low, high);
}

std::optional<double> number_of(std::string_view text) {
  const auto value = whole_text<double>(text);
  if (!value || !std::isfinite(*value) || std::fpclassify(*value) == FP_SUBNORMAL) return std::nullopt;
  return value;
}

std::optional<std::int64_t> whole_number_of(std::string_view text) {
  return whole_text<std::int64_t>(text);
}

double number_in(std::string_view text, std::string_view unit, const Interval& interval) {
  const auto value = number_of(text);
  if (!value) throw WrongOption("\"{}\" is no number; give {} in {}", text, unit, notation(interval));
  if (!contains(interval, *value)) throw WrongOption("{} is out of range; give {} in {}", text, unit, notation(interval));
  return *value;
}

std::int64_t whole_number_in(std::string_view text, std::string_view unit, std::int64_t low, std::int64_t high) {
  const auto value = whole_number_of(text);
  if (!value) throw WrongOption("\"{}\" is not a whole number; give {} in {}", text, unit, notation(low, high));
  if (*value < low || *value > high) throw WrongOption("{} is out of range; give {} in {}", text, unit, notation(low, high));
  return *value;
}

std::vector<double> numbers_in(std::string_view text, char separator, const Interval& interval, std::string_view form) {
  std::vector<double> values;
  for (std::size_t at = 0; at <= text.size();) {
    const std::string_view part = text.substr(at, text.find(separator, at) - at);
    const auto value = number_of(part);
    if (!value) throw WrongOption("{}: \"{}\" is no number; write {}", text, part, form);
    if (!contains(interval, *value)) throw WrongOption("{}: {} is not in {}; write {}", text, part, notation(interval), form);
    values.push_back(*value);
    at += part.size() + 1;
  }
  return values;
}

}  // namespace marey::pipeline::jobs

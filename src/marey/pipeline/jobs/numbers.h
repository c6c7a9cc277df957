#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/error.h"

namespace marey::pipeline::jobs {

/// A text that an option does not take, or options that exclude each other: wrong usage, not a failure of the outside world.
/// Options are spelled as on the command line ("--measured-only"); a front end that spells them otherwise replaces that.
class WrongOption : public Error {
 public:
  using Error::Error;
};

/// The numbers that an option takes; both ends are finite, so that a number in it is.
struct Interval {
  double low, high;
  bool open_low = false;  ///< `low` itself is not in it
};

constexpr Interval closed(double low, double high) {
  return {low, high};
}
constexpr Interval above(double low, double high) {
  return {low, high, true};
}

/// Frame rates of any recording, Hz.
inline constexpr Interval kRates = closed(0.001, 1e6);

bool contains(const Interval& interval, double value);

/// "(0, 1e6]".
std::string notation(const Interval& interval);
/// "[1, 500]"; the largest number that there is reads 2^63 - 1.
std::string notation(std::int64_t low, std::int64_t high);

/// The whole of `text` as a number; nothing if it is not one, is not finite, or is so small that its digits are lost (denormal).
std::optional<double> number_of(std::string_view text);
/// The whole of `text` as a whole number of 64 bits; nothing if it is not one.
std::optional<std::int64_t> whole_number_of(std::string_view text);

/// A number with its unit. Throws WrongOption, which states what `text` should be.
double number_in(std::string_view text, std::string_view unit, const Interval& interval);
std::int64_t whole_number_in(std::string_view text, std::string_view unit, std::int64_t low, std::int64_t high);

/// Numbers with `separator` between them, each in `interval`. Throws WrongOption, which states the expected `form`.
std::vector<double> numbers_in(std::string_view text, char separator, const Interval& interval, std::string_view form);

}  // namespace marey::pipeline::jobs

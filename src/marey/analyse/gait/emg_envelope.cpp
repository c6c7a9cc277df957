#include "marey/analyse/gait/emg_envelope.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <utility>

namespace marey::analyse::gait {
namespace {

constexpr double kMinRateHz = 60;  // numerical: 20 Hz need it

bool letter(char c) {
  return std::isalpha(static_cast<unsigned char>(c)) != 0;
}

}  // namespace

std::vector<double> emg_envelope(std::span<const double> signal, double rate_hz, const EmgOptions& options) {
  if (rate_hz < kMinRateHz || signal.size() < 3) return {};
  std::vector<double> values(signal.begin(), signal.end());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  for (double& value : values) value -= mean;
  const std::vector<double> slow = low_pass(values, options.high_pass_hz, rate_hz);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::abs(values[i] - slow[i]);
  values = low_pass(std::move(values), options.envelope_hz, rate_hz);
  for (double& value : values) value = std::max(value, 0.0);  // the filter's own overshoot
  return values;
}

std::optional<Side> side_of_label(std::string_view label) {
  label.remove_prefix(label.find_last_of(".:") + 1 == 0 ? 0 : label.find_last_of(".:") + 1);
  std::string lower(label);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const auto& [word, side] : {std::pair("left", Side::left), std::pair("right", Side::right)}) {
    if (lower.find(word) != std::string::npos) return side;
  }
  // A letter by itself at an end, or a capital before another: "L Rect", "RGast", "TA_R".
  const auto side_of = [](char c) {
    return c == 'L' || c == 'l' ? std::optional(Side::left) : c == 'R' || c == 'r' ? std::optional(Side::right) : std::nullopt;
  };
  if (label.size() < 2) return std::nullopt;
  const bool first_alone = !letter(label[1]) || (std::isupper(static_cast<unsigned char>(label[0])) != 0 &&
                                                 std::isupper(static_cast<unsigned char>(label[1])) != 0);
  if (const auto side = side_of(label.front()); side && first_alone) return side;
  if (const auto side = side_of(label.back()); side && !letter(label[label.size() - 2])) return side;
  return std::nullopt;
}

}  // namespace marey::analyse::gait

#include "marey/format/rig/rig_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/geometry/decompositions.h"

namespace marey::format::rig {
namespace {

constexpr double kMaxInFile = 1e9;       // of any number in the file
constexpr double kRotationSlack = 1e-3;  // what rounding to four digits leaves of RᵀR − I
constexpr double kRotationExact = 1e-9;  // above, the nearest rotation is taken

std::optional<double> number_in_node(const toml::node& node) {
  if (!node.is_integer() && !node.is_floating_point()) return std::nullopt;
  const double value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (!(std::abs(value) < kMaxInFile)) return std::nullopt;
  return value;
}

std::optional<std::vector<double>> numbers_of(const toml::node& node) {
  const toml::array* array = node.as_array();
  if (array == nullptr) return std::nullopt;
  std::vector<double> values;
  for (const toml::node& each : *array) {
    const auto value = number_in_node(each);
    if (!value) return std::nullopt;
    values.push_back(*value);
  }
  return values;
}

/// Keys that had another name in files of earlier versions.
constexpr std::array<std::pair<std::string_view, std::string_view>, 9> kEarlierKeys{{{"ptz", "turns"},
                                                                                     {"pivot", "tripod"},
                                                                                     {"axis_tilt", "lean"},
                                                                                     {"radial", "bend"},
                                                                                     {"centre", "middle"},
                                                                                     {"half_size", "half"},
                                                                                     {"crown_across", "across"},
                                                                                     {"crown_along", "along"},
                                                                                     {"crown_dome", "dome"}}};

/// Empty for a key that always had its name.
std::string_view earlier_name(std::string_view key) {
  for (const auto& [today, earlier] : kEarlierKeys) {
    if (key == today) return earlier;
  }
  return {};
}

}  // namespace

std::string excerpt(std::string_view text, std::size_t maximum) {
  std::string result(text.substr(0, maximum));
  for (char& c : result) {
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = '?';
  }
  return text.size() > maximum ? result + "..." : result;
}

void Problems::throw_if_any() {
  if (found_.empty()) return;
  std::stable_sort(found_.begin(), found_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  std::string all;
  for (const auto& [line, what] : found_) {
    all += fmt::format("{}{}:{}: {}", all.empty() ? "" : "\n", file_, std::max<unsigned>(1, line), what);
  }
  throw Error(all);
}

void Section::problem(std::string_view key, std::string_view what) const {
  const toml::node* node = find(key);
  problems_.add(node != nullptr ? node->source() : table_.source(), fmt::format("{}: {}", title_, what));
}

const toml::node* Section::find(std::string_view key) const {
  if (const toml::node* node = table_.get(key)) return node;
  const std::string_view earlier = earlier_name(key);
  return earlier.empty() ? nullptr : table_.get(earlier);
}

void Section::only(std::initializer_list<std::string_view> known) const {
  for (const auto& [key, value] : table_) {
    if (std::find(known.begin(), known.end(), key.str()) != known.end()) continue;
    const auto today = std::find_if(known.begin(), known.end(), [&](std::string_view k) { return earlier_name(k) == key.str(); });
    if (today != known.end()) {
      if (table_.contains(*today))
        problems_.add(key.source(), fmt::format("{}: {} is the earlier name of {}; keep one of them", title_, key.str(), *today));
      continue;
    }
    problems_.add(key.source(),
                  fmt::format("{}: unknown key \"{}\"; there are: {}", title_, excerpt(key.str()), fmt::join(known, ", ")));
  }
}

std::optional<std::string> Section::text(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto* value = node->as_string()) {
    if (value->get().find('\0') == std::string::npos) return value->get();
  }
  problem(key, fmt::format("{} must be a text in quotation marks", key));
  return std::nullopt;
}

std::optional<double> Section::number(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (const auto value = number_in_node(*node)) return value;
  problem(key, fmt::format("{} must be a finite number below 1e9", key));
  return std::nullopt;
}

std::optional<double> Section::positive(std::string_view key) const {
  const auto value = number(key);
  if (!value || *value > 0) return value;
  problem(key, fmt::format("{} is {}; it must be positive", key, *value));
  return std::nullopt;
}

std::optional<int> Section::count(std::string_view key) const {
  const auto value = number(key);
  if (!value) return std::nullopt;
  if (*value >= 0 && *value == std::floor(*value)) return static_cast<int>(*value);
  problem(key, fmt::format("{} is {}; it must be a count", key, *value));
  return std::nullopt;
}

std::optional<std::vector<double>> Section::numbers(std::string_view key, std::size_t min_count, std::size_t maximum,
                                                    std::string_view form) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  if (auto values = numbers_of(*node); values && values->size() >= min_count && values->size() <= maximum) return values;
  problem(key, fmt::format("{} must be {}", key, form));
  return std::nullopt;
}

std::vector<std::vector<double>> Section::rows(std::string_view key, std::size_t min_count, std::size_t maximum,
                                               std::string_view form) const {
  const toml::node* node = find(key);
  if (node == nullptr) return {};
  const toml::array* array = node->as_array();
  std::vector<std::vector<double>> rows;
  bool good = array != nullptr && array->size() <= maximum;
  for (std::size_t i = 0; good && i < array->size(); ++i) {
    auto row = numbers_of(*array->get(i));
    good = row && row->size() >= min_count;
    if (good) rows.push_back(std::move(*row));
  }
  if (good) return rows;
  problem(key, fmt::format("{} must be {}, {} at most", key, form, maximum));
  return {};
}

std::optional<Matrix<3>> Section::matrix(std::string_view key) const {
  const toml::node* node = find(key);
  if (node == nullptr) return std::nullopt;
  Matrix<3> result;
  const toml::array* rows = node->as_array();
  bool good = rows != nullptr && rows->size() == 3;
  for (std::size_t i = 0; good && i < 3; ++i) {
    const auto row = numbers_of(*rows->get(i));
    good = row && row->size() == 3;
    if (good) result.row(static_cast<int>(i)) = Eigen::Map<const Eigen::RowVector3d>(row->data());
  }
  if (good) return result;
  problem(key, fmt::format("{} must be three rows of three finite numbers", key));
  return std::nullopt;
}

std::optional<Matrix<3>> Section::invertible(std::string_view key) const {
  const auto result = matrix(key);
  if (!result) return std::nullopt;
  // Rows and columns may differ much in size (px, m): what counts is the angle between scaled columns.
  Matrix<3> even = *result;
  for (int i = 0; i < 3; ++i) even.col(i) /= std::max(even.col(i).norm(), 1e-300);
  for (int i = 0; i < 3; ++i) even.row(i) /= std::max(even.row(i).norm(), 1e-300);
  if (std::abs(even.determinant()) > 1e-9) return result;
  problem(key, fmt::format("{} is singular; it must map the plane one to one", key));
  return std::nullopt;
}

std::optional<Matrix<3>> Section::rotation(std::string_view key) const {
  const auto given = matrix(key);
  if (!given) return std::nullopt;
  const double off = (given->transpose() * *given - Matrix<3>::Identity()).cwiseAbs().maxCoeff();
  if (off > kRotationSlack) {
    problem(key,
            fmt::format("{} is not a rotation: its rows must have length 1 and be perpendicular, and are off by {:.2g}", key, off));
  } else if (given->determinant() < 0) {
    problem(key, fmt::format("{} is a mirroring (its determinant is -1); it must be a rotation", key));
  } else if (off < kRotationExact) {
    return given;
  } else {
    const geometry::SingularValues3 svd = geometry::singular_values(*given);
    return Matrix<3>(svd.U * svd.V.transpose());
  }
  return std::nullopt;
}

}  // namespace marey::format::rig

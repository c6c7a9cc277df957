#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <optional>
#include <ranges>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

// What is printed as JSON. The library that writes JSON is large; it is met in json_value.cpp alone.
namespace marey::cli {

class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::map<std::string, Json>;

  Json() = default;
  Json(std::nullptr_t) {}  // NOLINT: values are written as they are
  Json(bool value) : value_(value) {}
  template <std::floating_point T>
  Json(T value) : value_(static_cast<double>(value)) {}
  template <std::integral T>
    requires(!std::same_as<T, bool>)
  Json(T value) : value_(whole(value)) {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string_view text) : value_(std::string(text)) {}
  Json(const std::string& text) : value_(text) {}
  /// Null if there is no value.
  template <typename T>
  Json(const std::optional<T>& value) {
    if (value) *this = Json(*value);
  }
  template <std::ranges::input_range Range>
    requires(!std::convertible_to<const Range&, std::string_view> && !std::same_as<Range, Json>)
  Json(const Range& values) : value_(Array(std::ranges::begin(values), std::ranges::end(values))) {}
  /// {{"name", value}, …} is an object, any other list an array.
  Json(std::initializer_list<Json> list);

  static Json array() { return Json(Array()); }
  static Json object();

  /// The member of that name; what was null becomes an object.
  Json& operator[](const std::string& name);
  /// What was null becomes an array.
  void push_back(Json value);
  bool empty() const;

 private:
  friend struct JsonWriter;
  using Value = std::variant<std::nullptr_t, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object>;

  template <std::integral T>
  static Value whole(T value) {
    if constexpr (std::signed_integral<T>) {
      return static_cast<std::int64_t>(value);
    } else {
      return static_cast<std::uint64_t>(value);
    }
  }

  Value value_ = nullptr;
};

/// Null where it is empty.
inline Json path_or_null(const std::string& path) {
  return path.empty() ? Json() : Json(path);
}

/// On standard output, two blanks deep, with a newline behind it. Bytes that are not UTF-8 become U+FFFD.
void print(const Json& json);

/// On one line, for programs. Likewise.
std::string compact(const Json& json);

}  // namespace marey::cli

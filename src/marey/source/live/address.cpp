#include "marey/source/live/address.h"

#include <charconv>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/files/source_name.h"

namespace marey::source::live {
namespace {

template <typename T>
std::optional<T> parsed(std::string_view text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::optional<double> finite(std::string_view text) {
  const auto value = parsed<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::vector<std::string> pieces(const std::string& text, char between) {
  std::vector<std::string> all;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(between, begin), text.size());
    all.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return all;
}

}  // namespace

Address parse_address(const std::string& text) {
  Address address{.text = text, .scheme = std::string(scheme_of(text)), .location = {}, .options = {}};
  if (address.scheme.empty())
    throw Error("\"{}\" names no live source; write v4l2:, gige:, rtsp://, http://, play: or sim://", text);
  std::string rest = text.substr(address.scheme.size() + 1);
  if (rest.starts_with("//")) rest = rest.substr(2);
  if (address.scheme.starts_with("rtsp") || address.scheme.starts_with("http")) {
    address.location = rest;  // what stands behind "?" is the camera's own
    return address;
  }
  const auto query = rest.find('?');
  address.location = rest.substr(0, query);
  if (query == std::string::npos) return address;
  for (const std::string& pair : pieces(rest.substr(query + 1), '&')) {
    if (pair.empty()) continue;
    const auto sign = pair.find('=');
    const std::string name = pair.substr(0, sign);
    if (!address.options.emplace(name, sign == std::string::npos ? "yes" : pair.substr(sign + 1)).second)
      throw Error("{}: the option {} is given twice; keep one of them", text, name);
  }
  return address;
}

const std::string* AddressOptions::find(const char* name) {
  known_.insert(name);
  const auto found = address_.options.find(name);
  return found == address_.options.end() ? nullptr : &found->second;
}

void AddressOptions::refuse(const char* name, const std::string& required) const {
  throw Error("{}: {}={} is not possible; it must be {}", address_.text, name, address_.options.at(name), required);
}

void AddressOptions::whole(const char* name, int& value, int minimum, int maximum) {
  const std::string* given = find(name);
  if (given == nullptr) return;
  const auto number = parsed<int>(*given);
  if (!number || *number < minimum || *number > maximum)
    refuse(name, fmt::format("a whole number from {} to {}", minimum, maximum));
  value = *number;
}

void AddressOptions::number(const char* name, double& value, double minimum, double maximum) {
  const std::string* given = find(name);
  if (given == nullptr) return;
  const auto number = finite(*given);
  if (!number || *number < minimum || *number > maximum) refuse(name, fmt::format("a number from {} to {}", minimum, maximum));
  value = *number;
}

void AddressOptions::flag(const char* name, bool& value) {
  const std::string* given = find(name);
  if (given == nullptr) return;
  if (*given != "yes" && *given != "no") refuse(name, "yes or no");
  value = *given == "yes";
}

void AddressOptions::text(const char* name, std::string& value) {
  if (const std::string* given = find(name)) value = *given;
}

void AddressOptions::size(const char* name, int& width, int& height) {
  const std::string* given = find(name);
  if (given == nullptr) return;
  const auto sides = pieces(*given, 'x');
  const auto side = [&](std::size_t i) { return i < sides.size() ? parsed<int>(sides[i]) : std::nullopt; };
  constexpr int kMaxSide = 16384;
  const auto w = side(0), h = side(1);
  if (sides.size() != 2 || !w || !h || *w < 1 || *h < 1 || *w > kMaxSide || *h > kMaxSide)
    refuse(name, "WIDTHxHEIGHT in px, as 640x480");
  width = *w;
  height = *h;
}

void AddressOptions::numbers(const char* name, std::vector<double>& values, std::size_t count) {
  const std::string* given = find(name);
  if (given == nullptr) return;
  std::vector<double> all;
  for (const std::string& piece : pieces(*given, ',')) {
    const auto number = finite(piece);
    if (number) all.push_back(*number);
  }
  if (all.size() != count || pieces(*given, ',').size() != count)
    refuse(name, fmt::format("{} numbers with commas between", count));
  values = std::move(all);
}

void AddressOptions::done() const {
  for (const auto& [name, value] : address_.options) {
    if (!known_.contains(name))
      throw Error("{}: there is no option {}; there are: {}", address_.text, name, fmt::join(known_, ", "));
  }
}

}  // namespace marey::source::live

#include "marey/analyse/colour_names.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/core/colour.h"
#include "marey/core/error.h"

namespace marey::analyse {
namespace {

// Shirts in the open, recorded from afar: duller than a painter's colours.
constexpr std::array<ColourName, 14> kColourNames = {{
    {"white", {80, 0, 0}},
    {"black", {18, 0, 0}},
    {"grey", {46, 0, 0}},
    {"red", {42, 48, 28}},
    {"orange", {60, 35, 50}},
    {"yellow", {80, -5, 62}},
    {"green", {50, -40, 30}},
    {"turquoise", {60, -30, -10}},
    {"blue", {38, 10, -40}},
    {"purple", {35, 32, -32}},
    {"pink", {65, 38, 0}},
    {"brown", {32, 15, 20}},
    {"claret", {28, 32, 10}},
    {"sky blue", {68, -8, -28}},
}};

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> others = {
    {{"violet", "purple"}, {"gray", "grey"}, {"navy", "dark blue"}, {"maroon", "claret"}, {"cyan", "turquoise"}}};

constexpr float lighter = 20;  // L* by which "light" and "dark" change a colour

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

}  // namespace

std::span<const ColourName> colour_names() {
  return kColourNames;
}

Appearance colour_named(std::string_view name) {
  std::string word = lower(name);
  for (const auto& [other, typical] : others) {
    if (word == other) word = typical;
  }
  float shift = 0;
  for (const auto& [prefix, change] : {std::pair{std::string_view("light "), lighter}, {"dark ", -lighter}}) {
    if (!word.starts_with(prefix)) continue;
    shift = change;
    word = word.substr(prefix.size());
    break;
  }
  for (const ColourName& known : kColourNames) {
    if (known.word != word) continue;
    Appearance colour = known.typical;
    colour.lightness = std::clamp(colour.lightness + shift, 5.0F, 97.0F);
    return colour;
  }
  std::string all;
  for (const ColourName& known : kColourNames) all += fmt::format("{}{}", all.empty() ? "" : ", ", known.word);
  throw Error(fmt::format("\"{}\" is not a colour that is known here; there are {}, each also light or dark", name, all));
}

std::string name_of_colour(const Appearance& colour) {
  const auto nearest = std::min_element(kColourNames.begin(), kColourNames.end(), [&](const ColourName& a, const ColourName& b) {
    return colours_apart(a.typical, colour) < colours_apart(b.typical, colour);
  });
  return std::string(nearest->word);
}

double colours_apart(const Appearance& a, const Appearance& b) {
  return (perceived(a) - perceived(b)).norm();
}

}  // namespace marey::analyse

#pragma once

#include <span>
#include <string>
#include <string_view>

#include "marey/core/appearance.h"

namespace marey::analyse {

/// A word people use for a shirt's colour, and a shirt of that colour as video shows it.
struct ColourName {
  std::string_view word;
  Appearance typical;
};

/// All words that are understood.
std::span<const ColourName> colour_names();

/// "red", "light blue", "dark green"… Throws Error, listing the words, for another.
Appearance colour_named(std::string_view name);

/// The word that fits a shirt best.
std::string name_of_colour(const Appearance& colour);

/// The perceived difference of two shirts: the distance of their colours (core/colour.h).
double colours_apart(const Appearance& a, const Appearance& b);

}  // namespace marey::analyse

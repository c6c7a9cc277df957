#pragma once

#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "known.h"

namespace marey::cli {

/// An option that takes one of the names in `choices` and sets `value` to what stands beside it. Help and refusals list the names.
template <typename T>
CLI::Option* add_choice(CLI::App& app, const std::string& option, T& value, const std::map<std::string, T>& choices,
                        const std::string& meaning) {
  std::vector<std::string> names;
  for (const auto& [name, choice] : choices) names.push_back(name);
  const std::string listed = fmt::format("{}", fmt::join(names, ", "));
  return app
      .add_option_function<std::string>(
          option, [&value, choices](const std::string& name) { value = choices.at(name); }, meaning + ": " + listed)
      ->check(known([choices, listed](const std::string& name) {
        if (!choices.contains(name)) throw Error("\"{}\" is not known; known are: {}", name, listed);
      }));
}

}  // namespace marey::cli

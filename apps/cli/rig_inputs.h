#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "marey/core/rig.h"

namespace marey::cli {

/// The command line's `rig.toml [cam=VIDEO …] [--observations FILE|DIR]`.
struct RigInputs {
  std::string rig;
  std::vector<std::string> videos;  ///< cam=VIDEO
  std::string observations;
};

void add_rig_inputs(CLI::App& command, RigInputs& inputs);

/// The rig that they name, its cameras' sources replaced; of observations alone the rig that these tell of. Throws Error.
Rig rig_of(const RigInputs& inputs);

/// Numbers between commas. Throws Error with the option's name and the form it should have.
std::vector<double> numbers_in(const std::string& text, const char* option, const char* form);

}  // namespace marey::cli

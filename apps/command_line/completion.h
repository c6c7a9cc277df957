#pragma once

#include <string>

#include "command_line.h"

namespace marey::cli {

/// What a shell needs to complete the program's words: "bash", "zsh" or "fish". Throws WrongUsage for another.
std::string completion_for(const Command& root, const std::string& shell);

/// Writes a manual page for the program and for each command into the folder, which is made: marey.1, marey-track.1, … as their
/// help texts say. Throws Error if that cannot be.
void write_manual(const Command& root, const std::string& folder);

}  // namespace marey::cli

#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "marey/core/error.h"

namespace marey::cli {

/// A value that `parse` must take, or the command line is wrong: its message, which lists what is valid, is shown.
template <typename Parse>
CLI::Validator known(const Parse& parse) {
  return CLI::Validator(
      [parse](std::string& text) -> std::string {
        try {
          parse(text);
          return "";
        } catch (const Error& error) {
          return error.what();
        }
      },
      "");
}

}  // namespace marey::cli

#include "commands.h"

namespace marey::cli {

void add_evaluate(CLI::App& app) {
  app.add_subcommand("evaluate", "Judge tracks against the truth");
}

}  // namespace marey::cli

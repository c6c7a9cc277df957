#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

extern "C" {
#include <libavutil/log.h>
}

#include "commands.h"

int main(int argc, char** argv) {
  av_log_set_level(AV_LOG_QUIET);  // what went wrong in a film is told in our own sentences
  CLI::App app{"Marey turns what cameras see into motion you can measure.", "marey"};
  app.require_subcommand(1);
  marey::cli::add_track(app);
  marey::cli::add_evaluate(app);
  marey::cli::add_measure(app);
  marey::cli::add_simulate(app);
  marey::cli::add_calibrate(app);
  marey::cli::add_convert(app);
  marey::cli::add_info(app);
  marey::cli::add_reconstruct(app);
  marey::cli::add_experiment(app);
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::RuntimeError& error) {
    return error.get_exit_code();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "marey: {}\n", error.what());
    return 1;
  }
}

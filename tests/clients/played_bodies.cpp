// Plays the recording of tests/support/moving_bodies.h, which has bodies and a skeleton, over wires: played_bodies SECONDS WIRE ...
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "marey/pipeline/take/play.h"
#include "marey/stream/streams.h"

#include "support/moving_bodies.h"

int main(int argc, char** argv) {
  if (argc < 3) return 2;
  const int instants = static_cast<int>(100 * std::strtod(argv[1], nullptr));
  try {
    const std::vector<std::string> protocols(argv + 2, argv + argc);
    const marey::stream::Streams streams(protocols, {.allow_control = true, .record = [](bool) { return true; }});
    for (const auto& report : streams.reports()) std::printf("%s %s\n", report.protocol.c_str(), report.where.c_str());
    std::fflush(stdout);
    marey::pipeline::take::play([&] { return std::make_unique<marey::test::MovingBodies>(instants); }, streams.sinks(), {},
                                &streams.clock());
    for (const auto& report : streams.reports()) std::printf("%s\n", to_string(report).c_str());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}

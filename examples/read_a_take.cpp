// Reads a take: its people, and one marker's path without the rest; draws all of it from above.
//   read_a_take walk.marey drawing.svg
#include <cstdio>
#include <fstream>

#include "marey/core/error.h"
#include "marey/draw/trajectory_plot.h"
#include "marey/format/take/take_file.h"

int main(int argc, char** argv) try {
  if (argc != 3) return std::puts("usage: read_a_take TAKE PICTURE.svg"), 2;
  marey::format::take::TakeReader reader(argv[1], {.detected = false, .limits = {}});
  std::printf("%s, %g Hz, made by %s\n", marey::to_string(reader.header().frame).c_str(), reader.header().rate_hz,
              reader.header().made_by.program.c_str());
  for (const marey::TrackName& track : reader.tracks()) {
    const marey::TrackColumns path = reader.read_track(track.id);
    std::printf("%3d %-10s %6zu samples\n", marey::number(track.id), track.label.c_str(), path.size());
  }
  marey::draw::TrajectoryPlot plot;
  while (const auto instant = reader.next()) plot.add(*instant);
  std::ofstream(argv[2]) << plot.to_svg("from above");
  return 0;
} catch (const marey::Error& error) {
  return std::fprintf(stderr, "%s\n", error.what()), 1;
}

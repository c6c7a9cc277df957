// Calls every module of the installed library once, so that all of it links.
#include <fstream>
#include <vector>

#include <marey/analyse/measure.h>
#include <marey/assign/linear_assignment.h>
#include <marey/calibrate/two_views.h>
#include <marey/core/error.h>
#include <marey/detect/background/background.h>
#include <marey/draw/chart.h>
#include <marey/evaluate/evaluation.h>
#include <marey/filter/filters.h>
#include <marey/format/rig/rig_file.h>
#include <marey/format/take/take_file.h>
#include <marey/geometry/pitch.h>
#include <marey/pipeline/people/track_in_image.h>
#include <marey/reconstruct/triangulate.h>
#include <marey/simulate/random.h>
#include <marey/source/open_source.h>
#include <marey/track/offline/join.h>

namespace {

template <typename Call>
bool refuses(Call&& call) {
  try {
    call();
  } catch (const marey::Error&) {
    return true;
  }
  return false;
}

}  // namespace

int main(int, char** argv) {
  using namespace marey;
  RigCamera camera;
  const std::string tracks = argv[1];
  camera.detections = tracks + ".det";
  camera.rate_hz = 25;
  std::ofstream file(camera.detections);
  for (int frame = 1; frame < 50; ++frame) file << frame << ",-1," << 100 + 3 * frame << ",50,40,100,0.9\n";
  file.close();
  if (pipeline::people::track_people(camera, {.tracks = tracks}).tracks != 1) return 1;

  camera.name = "cam";
  format::rig::write_rig({.ground_from_world = {}, .calibration = {}, .cameras = {camera}}, tracks + ".toml");
  if (format::rig::read_rig(tracks + ".toml").cameras.size() != 1) return 2;
  if (!refuses([] { source::open_source("no_such_film.mp4"); })) return 3;
  if (!refuses([] { format::take::TakeReader("no_such_take.marey"); })) return 4;
  if (filter::named_filters().empty() || geometry::pitch_lines({}, 1).empty()) return 5;
  const bool all = detect::background::make_background({}) != nullptr && !reconstruct::meaning(reconstruct::NoPoint{}).empty() &&
                   simulate::Random(1).uniform(0, 1) < 1;
  return all ? 0 : 6;
}

#include <fstream>

#include <marey/pipeline/track_in_picture.h>

int main(int, char** argv) {
  marey::RigCamera camera;
  const std::string tracks = argv[1];
  camera.detections = tracks + ".det";
  camera.rate_hz = 25;
  std::ofstream file(camera.detections);
  for (int frame = 1; frame < 50; ++frame) file << frame << ",-1," << 100 + 3 * frame << ",50,40,100,0.9\n";
  file.close();
  return marey::pipeline::track_people(camera, {.tracks = tracks}).tracks == 1 ? 0 : 1;
}

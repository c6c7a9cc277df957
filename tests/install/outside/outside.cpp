#include <fstream>

#include <marey/pipeline/track_people.h>

int main(int, char** argv) {
  const std::string tracks = argv[1], detections = tracks + ".det";
  std::ofstream file(detections);
  for (int frame = 1; frame < 50; ++frame) file << frame << ",-1," << 100 + 3 * frame << ",50,40,100,0.9\n";
  file.close();
  return marey::track_people({.detections = detections, .rate_hz = 25}, {.tracks = tracks}).people == 1 ? 0 : 1;
}

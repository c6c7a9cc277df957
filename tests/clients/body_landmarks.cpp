// Runs a landmark network on one image, for keypoints_test.py to compare with another program.
//
//   body_landmarks NETWORK.onnx IMAGE LEFT TOP WIDTH HEIGHT CROP.bin
//
// Writes what the network was shown, 256 × 256 × 3 bytes, blue first, into CROP.bin. Prints the network's own numbers for each of
// its 39 points, x y z visibility presence, a line each; a line with the person's presence; then for each of the 33 points of a
// body its place in the image, px, and covariance:
//   x y xx xy yy visibility presence
#include <cstdlib>
#include <fstream>

#include <fmt/core.h>

#include "marey/core/error.h"
#include "marey/detect/keypoints/landmark_network.h"
#include "marey/source/open_source.h"

namespace {

void print_landmarks(char** argv) {
  using namespace marey::detect::keypoints;
  LandmarkNetwork network(argv[1]);
  const auto frame = marey::source::open_source(argv[2])->next();
  if (!frame) throw marey::Error("{}: cannot be read", argv[2]);
  const PersonRegion region = region_of(marey::Box{std::atof(argv[3]), std::atof(argv[4]), std::atof(argv[5]), std::atof(argv[6])});
  const cv::Mat crop = crop_of(frame->image.bgr(), region);
  std::ofstream(argv[7], std::ios::binary).write(crop.ptr<char>(), static_cast<std::streamsize>(crop.total() * crop.elemSize()));
  const auto outputs = network.raw(crop);
  for (std::size_t i = 0; i < outputs[0].values.size(); ++i) fmt::print("{:.9g}{}", outputs[0].values[i], i % 5 == 4 ? '\n' : ' ');
  fmt::print("{:.9g}\n", outputs[1].values.front());
  for (const auto& point : body_of(outputs, region).keypoints.points) {
    fmt::print("{:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n", point->position.x(), point->position.y(),
               point->covariance(0, 0), point->covariance(0, 1), point->covariance(1, 1), point->visibility, point->presence);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 8) {
    fmt::print(stderr, "usage: body_landmarks NETWORK.onnx IMAGE LEFT TOP WIDTH HEIGHT CROP.bin\n");
    return 2;
  }
  try {
    print_landmarks(argv);
  } catch (const marey::Error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}

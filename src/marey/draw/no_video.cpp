// In place of jpeg.cpp, movie_writer.cpp and image_file.cpp in a build without FFmpeg's libraries (MAREY_FFMPEG=OFF): nothing is
// encoded.
#include "marey/core/error.h"
#include "marey/draw/image_file.h"
#include "marey/draw/jpeg.h"
#include "marey/draw/movie_writer.h"

namespace marey::draw {

struct MovieWriter::Parts {};

MovieWriter::MovieWriter(const std::string& path, cv::Size, std::optional<double>, Quality, Keep, const std::string&) {
  throw Error("{}: this build of Marey writes no videos; the Debian packages do", path);
}
MovieWriter::~MovieWriter() = default;
void MovieWriter::write(const Image&, Timestamp) {}
void MovieWriter::finish() {}

JpegEncoder::JpegEncoder() : handle_(nullptr) {}
JpegEncoder::~JpegEncoder() = default;
std::string JpegEncoder::encode(const Image&, int, int) {
  return {};
}

void write_image(const std::string& path, const Image&) {
  throw Error("{}: this build of Marey writes no images; the Debian packages do", path);
}

}  // namespace marey::draw

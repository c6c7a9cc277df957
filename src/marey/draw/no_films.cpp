// In place of jpeg.cpp, movie_writer.cpp and picture_file.cpp in a build without FFmpeg's libraries (MAREY_FFMPEG=OFF): nothing is
// encoded.
#include "marey/core/error.h"
#include "marey/draw/jpeg.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/picture_file.h"

namespace marey::draw {

struct MovieWriter::Parts {};

MovieWriter::MovieWriter(const std::string& path, cv::Size, std::optional<double>, Quality, Keep, const std::string&) {
  throw Error("{}: this build of Marey writes no films; the Debian packages do", path);
}
MovieWriter::~MovieWriter() = default;
void MovieWriter::write(const Picture&, Timestamp) {}
void MovieWriter::finish() {}

JpegEncoder::JpegEncoder() : handle_(nullptr) {}
JpegEncoder::~JpegEncoder() = default;
std::string JpegEncoder::encode(const Picture&, int, int) {
  return {};
}

void write_picture(const std::string& path, const Picture&) {
  throw Error("{}: this build of Marey writes no pictures; the Debian packages do", path);
}

}  // namespace marey::draw

#include "marey/source/focal_length.h"

#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/files.h"

namespace marey::source {
namespace {

/// A JPEG with an EXIF block that has one entry, FocalLengthIn35mmFilm (0xA405, a short), in its inner directory (0x8769).
std::string photo(int focal_35mm) {
  const test::TemporaryFolder folder;
  test::ffmpeg("-f lavfi -i color=gray:size=64x48 -frames:v 1 " + (folder / "plain.jpg"));
  const std::string plain = test::read_file(folder / "plain.jpg");
  std::string exif("Exif\0\0MM\0\x2a\0\0\0\x08", 14);
  exif += std::string("\0\x01\x87\x69\0\x04\0\0\0\x01\0\0\0\x1a\0\0\0\0", 18);
  exif += std::string("\0\x01\xa4\x05\0\x03\0\0\0\x01", 10);
  exif += static_cast<char>(focal_35mm >> 8);
  exif += static_cast<char>(focal_35mm & 255);
  exif += std::string("\0\0\0\0\0\0", 6);
  std::string bytes = plain.substr(0, 2);
  const std::size_t length = exif.size() + 2;
  bytes += std::string("\xff\xe1", 2) + static_cast<char>(length >> 8) + static_cast<char>(length & 255) + exif;
  return bytes + plain.substr(2);
}

TEST(FocalLength, IsThatOfAFoldersFirstImage) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "image2.jpg", photo(26));
  test::write_file(folder / "image10.jpg", photo(300));
  EXPECT_EQ(focal_35mm_of(folder / "image2.jpg"), 26);
  EXPECT_EQ(focal_35mm_of(folder / "image10.jpg"), 300) << "two bytes";
  EXPECT_EQ(focal_35mm_of(folder / ""), 26);
  EXPECT_EQ(focal_35mm_of(folder / "image%d.jpg"), 26);
}

TEST(FocalLength, IsThatOfAPhonesVideo) {
  const test::TemporaryFolder folder;
  test::ffmpeg(
      "-f lavfi -i color=gray:size=64x48:rate=5:duration=1 -metadata com.apple.quicktime.camera.focal_length.35mm_equivalent=24 "
      "-movflags use_metadata_tags " +
      (folder / "phone.mov"));
  EXPECT_EQ(focal_35mm_of(folder / "phone.mov"), 24);
}

TEST(FocalLength, FilesWithoutALensHaveNone) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "unknown.jpg", photo(0));
  EXPECT_FALSE(focal_35mm_of(folder / "unknown.jpg"));
  test::ffmpeg("-f lavfi -i color=gray:size=64x48 -frames:v 1 " + (folder / "plain.jpg"));
  EXPECT_FALSE(focal_35mm_of(folder / "plain.jpg"));
  EXPECT_FALSE(focal_35mm_of(folder / "nothing%d.jpg"));
  EXPECT_THROW(focal_35mm_of(folder / "missing.mp4"), Error);
}

TEST(FocalLength, DamagedFilesAreNoLens) {
  const test::TemporaryFolder folder;
  const std::string whole = photo(26);
  for (std::size_t length = 0; length < whole.size(); length += 5) {
    test::write_file(folder / "cut.jpg", whole.substr(0, length));
    try {
      const auto found = focal_35mm_of(folder / "cut.jpg");
      EXPECT_TRUE(!found || *found == 26) << length;
    } catch (const Error&) {  // not an image any more
    }
  }
}

TEST(FocalLength, PixelsAreThoseOfTheDiagonal) {
  // Frame and image have one angle of view: the diagonal's half angle is atan(1/2) where the focal length is the diagonal.
  EXPECT_NEAR(focal_px_of(43.27, {1600, 1200}), 2000, 1e-9);
  EXPECT_NEAR(focal_px_of(26, {1920, 1080}), 26 / 43.27 * 2202.9, 0.1);
}

}  // namespace
}  // namespace marey::source

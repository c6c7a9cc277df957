#pragma once

#include <optional>
#include <string>

#include <opencv2/core.hpp>

namespace marey::source {

/// The focal length (mm) that a camera wrote into a video, or into the first of a folder's images, as its 35 mm equivalent by the
/// same diagonal: EXIF's FocalLengthIn35mmFilm, or QuickTime's camera.focal_length.35mm_equivalent (phones). Nothing if it states
/// none, or none of a lens. It is that of the whole sensor: videos that are cropped or stabilised have a longer one, often by a
/// tenth. Throws Error if `path` cannot be read.
std::optional<double> focal_35mm_of(const std::string& path);

/// The same in pixels of an image; CIPA DCG-001: a 35 mm frame has a diagonal of 43.27 mm.
double focal_px_of(double focal_35mm, cv::Size image);

}  // namespace marey::source

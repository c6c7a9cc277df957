#pragma once

#include <optional>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"
#include "marey/core/image.h"

namespace marey::detect::background {

/// What has gone that the scene held. `scene` and `now` are the same part of an image, `body` is where in it (px, from its upper
/// left corner) something as large as the body that is searched for began to move. The answer is the one region there that differs,
/// as a mask of the part's size (CV_8UC1), where it is of the size of a body and its border is an edge in the scene and none in the
/// image: the place of something that has left shows the ground as it continues about it, and what stands there now would have an
/// outline of its own.
std::optional<cv::Mat> uncovered(const Image& scene, const Image& now, const Box& body);

/// Whether two such parts show the same within `mask`, but for a change of light.
bool same_within(const Image& a, const Image& b, const cv::Mat& mask);

/// `image` with what `patch` shows where `mask` (CV_8UC1) is not 0, in the light of the image; both lie at `corner`, which is
/// even.
Image patched(const Image& image, const Image& patch, const cv::Mat& mask, cv::Point corner);

}  // namespace marey::detect::background

#pragma once

#include <string>
#include <string_view>

#include "marey/format/tracks/mots.h"

namespace marey::format::tracks {

/// COCO instances as JSON: `images` (id, width, height), `annotations` (image_id, track_id, segmentation as polygons or runs). The
/// frame of an image is its `frame_id` from 0 if it has one, else its place in the order of the ids. A pixel's corner is (0, 0) in
/// the file, its centre here. Annotations without `track_id` are numbered in their frame, with a warning. Throws Error for anything
/// malformed.
MaskTable parse_coco_instances(std::string_view text, const std::string& path);

/// Whether a text may be such JSON.
bool is_coco_instances(std::string_view text);

/// The masks of a file of MOTS text or COCO instances. Throws Error if it is neither.
MaskTable read_masks(const std::string& path);

/// Whether a file has masks: MOTS text or COCO instances. False if it cannot be read.
bool has_masks(const std::string& path);

}  // namespace marey::format::tracks

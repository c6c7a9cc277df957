// COCO instances: Lin et al., "Microsoft COCO: Common Objects in Context", 2014, with `track_id` as in the video data sets that
// follow it (TAO, MOTS in COCO form).
#include "marey/format/tracks/coco_instances.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <set>
#include <utility>

#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/format.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"

namespace marey::format::tracks {
namespace {

using nlohmann::json;

struct CocoImage {
  std::int32_t frame = 0;
  int width = 0, height = 0;
};

std::map<std::int64_t, CocoImage> images_of(const json& root, const std::string& path) {
  constexpr int kMaxSidePx = 100'000;
  std::map<std::int64_t, CocoImage> images;
  for (const json& one : root.at("images")) {
    CocoImage image{.width = one.at("width").get<int>(), .height = one.at("height").get<int>()};
    const auto id = one.at("id").get<std::int64_t>();
    if (image.width < 1 || image.height < 1 || image.width > kMaxSidePx || image.height > kMaxSidePx) {
      throw Error("{}: image {} is {} x {} px; expected 1 to {} px each", path, id, image.width, image.height, kMaxSidePx);
    }
    image.frame = one.value("frame_id", -1);
    if (!images.emplace(id, image).second) throw Error("{}: two images have the id {}", path, id);
  }
  std::int32_t next = 0;
  for (auto& [id, image] : images) {
    if (image.frame < 0) image.frame = next;
    ++next;
  }
  return images;
}

/// The union of polygons: pixels in an odd number of them count once more where they overlap.
RunMask mask_of_polygons(const json& polygons, const CocoImage& image, const std::string& path) {
  RunMask all{image.width, image.height, {static_cast<std::uint32_t>(image.width) * static_cast<std::uint32_t>(image.height)}};
  for (const json& one : polygons) {
    const auto numbers = one.get<std::vector<double>>();
    if (numbers.size() < 6 || numbers.size() % 2 != 0) {
      throw Error("{}: a polygon of {} numbers; expected x and y of three corners or more", path, numbers.size());
    }
    std::vector<Vector<2>> polygon;
    for (std::size_t i = 0; i < numbers.size(); i += 2) polygon.emplace_back(numbers[i] - 0.5, numbers[i + 1] - 0.5);
    const RunMask part = RunMask::of_polygon(polygon, image.width, image.height);
    RunMaskBuilder both(image.width, image.height);
    for_common_runs(all, part, [&](bool a, bool b, std::uint32_t length) { both.add(a || b, length); });
    all = both.take();
  }
  return all;
}

RunMask mask_of_runs(const json& runs, const CocoImage& image, const std::string& path) {
  const json& counts = runs.at("counts");
  if (counts.is_string()) return mask_of_compressed(counts.get_ref<const std::string&>(), image.width, image.height);
  RunMaskBuilder mask(image.width, image.height);
  std::int64_t sum = 0;
  bool inside = false;
  for (const json& one : counts) {
    const auto length = one.get<std::int64_t>();
    sum += length;
    if (length < 0 || sum > std::int64_t{image.width} * image.height) throw Error("{}: runs of a mask beyond its image", path);
    mask.add(inside, static_cast<std::uint32_t>(length));
    inside = !inside;
  }
  if (sum != std::int64_t{image.width} * image.height) throw Error("{}: runs of a mask do not fill its image", path);
  return mask.take();
}

}  // namespace

MaskTable parse_coco_instances(std::string_view text, const std::string& path) {
  MaskTable table;
  check_nesting(text, Notation::json, path);
  try {
    const json root = json::parse(text);
    const std::map<std::int64_t, CocoImage> images = images_of(root, path);
    std::map<std::int32_t, std::int32_t> unnamed;
    std::set<std::pair<std::int32_t, std::int32_t>> known;
    for (const json& one : root.at("annotations")) {
      const auto image = images.find(one.at("image_id").get<std::int64_t>());
      if (image == images.end()) throw Error("{}: an annotation of an image that is not in `images`", path);
      LabelledMask mask{.frame = image->second.frame, .id = one.value("track_id", -1), .mask = {}};
      const json& shape = one.at("segmentation");
      mask.mask = shape.is_object() ? mask_of_runs(shape, image->second, path) : mask_of_polygons(shape, image->second, path);
      const bool crowd = one.value("iscrowd", 0) != 0;
      if (!crowd && mask.id < 0) mask.id = unnamed[mask.frame]++;
      if (!crowd && !known.emplace(mask.frame, mask.id).second)
        throw Error("{}: track {} is twice in frame {}; expected once", path, mask.id, mask.frame);
      (crowd ? table.ignored : table.masks).push_back(std::move(mask));
    }
    if (!unnamed.empty()) table.warnings.push_back(path + ": annotations without track_id; their identities mean nothing");
  } catch (const json::exception&) {
    throw Error("{}: is not JSON of COCO instances; expected images (id, width, height) and annotations (image_id, segmentation)",
                path);
  }
  for (auto* masks : {&table.masks, &table.ignored}) {
    std::stable_sort(masks->begin(), masks->end(), [](const LabelledMask& a, const LabelledMask& b) {
      return std::pair(a.frame, a.id) < std::pair(b.frame, b.id);
    });
  }
  return table;
}

bool is_coco_instances(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && text[first] == '{' && text.find("\"segmentation\"") != std::string_view::npos;
}

MaskTable read_masks(const std::string& path) {
  const std::string text = read_file(path);
  if (is_coco_instances(text)) return parse_coco_instances(text, path);
  return parse_mots(text, path);
}

bool has_masks(const std::string& path) {
  if (path == "-") return false;
  const Beginning file = beginning_of(path);
  if (file.folder || !file.is_text()) return false;
  return is_mots_text(file.text()) || is_coco_instances(file.text());
}

}  // namespace marey::format::tracks

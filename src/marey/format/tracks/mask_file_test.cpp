#include "marey/format/tracks/mask_file.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/tracks/coco_instances.h"
#include "marey/format/tracks/mots.h"

#include "support/files.h"

namespace marey::format::tracks {
namespace {

TEST(CompressedRuns, AreThoseOfCoco) {
  // As pycocotools 2.0.11 encodes them.
  EXPECT_EQ(compressed_runs({3, 4, {5, 3, 4}}), "534");
  EXPECT_EQ(compressed_runs({3, 4, {0, 12}}), "0<");
  EXPECT_EQ(compressed_runs({100, 40, {1000, 40, 60, 2900}}), "Xo0X1l1\\i2");
}

TEST(CompressedRuns, ComeBackAsTheyWere) {
  const std::uint64_t seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937_64 random(seed);
  for (int trial = 0; trial < 200; ++trial) {
    RunMaskBuilder builder(70, 50);
    std::uint32_t left = 70 * 50;
    for (bool inside = trial % 2 == 0; left > 0; inside = !inside) {
      const std::uint32_t length = std::min<std::uint32_t>(left, 1 + random() % (trial % 3 == 0 ? 900 : 12));
      builder.add(inside, length);
      left -= length;
    }
    const RunMask mask = builder.take();
    EXPECT_EQ(mask_of_compressed(compressed_runs(mask), 70, 50), mask);
  }
}

TEST(CompressedRuns, RejectsMalformedText) {
  for (const std::string text : {"", "534", "53", "~~", "P", "5P", "oooooooooo0", "53\xff"}) {
    EXPECT_THROW(mask_of_compressed(text, 4, 4), Error) << text;
  }
}

Sample with_contour(int id, double left, double top, std::vector<TrackId> behind) {
  auto contour = std::make_shared<Outline>();
  contour->order = 2;  // a polygon
  contour->control_points = {{left, top}, {left + 10, top}, {left + 10, top + 20}, {left, top + 20}};
  contour->behind = std::move(behind);
  Sample sample;
  sample.track = TrackId{id};
  sample.position = {left + 5, top + 10, 0};
  sample.box = Box{left + 0.5, top + 0.5, 10, 20};
  sample.outline = std::move(contour);
  return sample;
}

RecordingHeader header_of(int width, int height) {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::image;
  header.rig = Rig{};
  header.rig->cameras.emplace_back();
  header.rig->cameras.front().size = cv::Size(width, height);
  return header;
}

/// Two contours that overlap by 5 × 20 px; the second, lower one is behind the first.
Instant overlapping() {
  Instant instant;
  instant.index = 4;
  instant.samples = {with_contour(3, 9.5, 9.5, {}), with_contour(8, 14.5, 9.6, {TrackId{3}})};
  return instant;
}

TEST(MaskFile, WritesVisiblePartsAsMots) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "masks.txt";
  MaskFile file(path, MaskText::mots);
  EXPECT_FALSE(file.begin(header_of(60, 40)).images);
  file.write(overlapping());
  file.finish();
  EXPECT_TRUE(has_masks(path));
  const MaskTable table = read_masks(path);
  ASSERT_EQ(table.masks.size(), 2U);
  EXPECT_EQ(table.masks[0].frame, 4);
  EXPECT_EQ(table.masks[0].id, 3);
  EXPECT_EQ(table.masks[0].mask.area(), 200);
  EXPECT_EQ(table.masks[0].mask.box(), (Box{10, 10, 10, 20}));
  EXPECT_EQ(table.masks[1].id, 8);
  EXPECT_EQ(table.masks[1].mask.area(), 100);
  EXPECT_EQ(shared_area(table.masks[0].mask, table.masks[1].mask), 0);
}

TEST(MaskFile, WritesWholeContoursAsCoco) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "contours.json";
  MaskFile file(path, MaskText::coco);
  file.begin(header_of(60, 40));
  file.write(overlapping());
  Instant empty;
  empty.index = 5;
  file.write(empty);
  file.finish();
  EXPECT_TRUE(has_masks(path));
  const MaskTable table = read_masks(path);
  ASSERT_EQ(table.masks.size(), 2U);
  EXPECT_EQ(table.masks[1].frame, 4);
  EXPECT_EQ(table.masks[1].id, 8);
  EXPECT_EQ(table.masks[1].mask.area(), 200);
  EXPECT_EQ(table.masks[1].mask.width, 60);
}

TEST(MaskFile, RefusesPositionsOnTheGround) {
  const test::TemporaryFolder folder;
  MaskFile file(folder / "masks.txt", MaskText::mots);
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::ground;
  EXPECT_THROW(file.begin(header), Error);
}

TEST(Mots, RejectsMalformedLines) {
  const std::string good = "1 5 2 4 3 534\n";
  EXPECT_EQ(parse_mots(good, "a").masks.size(), 1U);
  EXPECT_EQ(parse_mots("1 10000 10 4 3 534\n", "a").ignored.size(), 1U);
  for (const std::string bad : {"0 5 2 4 3 534", "1 -5 2 4 3 534", "1 5 2 4 3", "1 5 2 4 4 534", "1 x 2 4 3 534", "1 5 2 0 3 534",
                                "1 5 2 4 3 534\n1 5 2 4 3 534"}) {
    EXPECT_THROW(parse_mots(bad, "a"), Error) << bad;
  }
  EXPECT_FALSE(is_mots_text("1,5,2,4,3,10"));
  EXPECT_FALSE(is_mots_text("1 5 20 40 30 10"));
}

TEST(CocoInstances, RejectsMalformedJson) {
  const std::string images = R"({"images":[{"id":1,"width":6,"height":4}],"annotations":[)";
  const auto with = [&](const std::string& annotation) { return images + annotation + "]}"; };
  EXPECT_EQ(
      parse_coco_instances(with(R"({"image_id":1,"track_id":2,"segmentation":[[1,1,4,1,4,3,1,3]]})"), "a").masks[0].mask.area(), 6);
  EXPECT_EQ(
      parse_coco_instances(with(R"({"image_id":1,"track_id":2,"segmentation":{"counts":[4,8,12]}})"), "a").masks[0].mask.area(), 8);
  EXPECT_EQ(parse_coco_instances(with(R"({"image_id":1,"segmentation":[[1,1,4,1,4,3,1,3]]})"), "a").warnings.size(), 1U);
  for (
      const std::string bad :
      {R"({"image_id":7,"segmentation":[[1,1,4,1,4,3]]})", R"({"image_id":1,"segmentation":[[1,1,4,1]]})",
       R"({"image_id":1,"segmentation":{"counts":[4,8]}})", R"({"image_id":1,"segmentation":{"counts":[-4,28]}})",
       R"({"image_id":1})",
       R"({"image_id":1,"track_id":1,"segmentation":[[1,1,4,1,4,3]]},{"image_id":1,"track_id":1,"segmentation":[[1,1,4,1,4,3]]})"}) {
    EXPECT_THROW(parse_coco_instances(with(bad), "a"), Error) << bad;
  }
  EXPECT_THROW(parse_coco_instances("{\"segmentation\"", "a"), Error);
}

}  // namespace
}  // namespace marey::format::tracks

#include "marey/analyse/gait/body_marker_sets.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::analyse::gait {
namespace {

using Labels = std::set<std::string, std::less<>>;

Labels labels_of(const BodyMarkerSet& set) {
  Labels all;
  for (const auto& part :
       {"ASI",       "PSI",          "FWT",          "BWT",         "THI",          "KNE",          "TIB",         "SHN",
        "ANK",       "HEE",          "TOE",          ".ASIS",       ".Thigh.Upper", ".Thigh.Front", ".Thigh.Rear", ".Knee.Lat",
        ".Knee.Med", ".Shank.Upper", ".Shank.Front", ".Shank.Rear", ".Ankle.Lat",   ".Heel",        ".Toe.Tip"}) {
    for (const std::string side : {"L", "R"}) {
      if (set.has(side + part)) all.insert(side + part);
    }
  }
  if (set.has("V.Sacral")) all.insert("V.Sacral");
  return all;
}

TEST(BodyMarkerSets, EachIsKnownByItsLabels) {
  for (const BodyMarkerSet& set : body_marker_sets()) {
    const Labels labels = labels_of(set);
    EXPECT_TRUE(set.missing(labels).empty()) << set.name();
    EXPECT_EQ(recognised_marker_set(labels).name(), set.name());
    EXPECT_EQ(body_marker_set(set.name()).title(), set.title());
  }
}

TEST(BodyMarkerSets, LabelsAreListedByName) {
  const auto has = [](const std::vector<std::string>& labels, const std::string& label) {
    return std::find(labels.begin(), labels.end(), label) != labels.end();
  };
  for (const BodyMarkerSet& set : body_marker_sets()) EXPECT_EQ(marker_set_labels(set.name()).size(), set.size());
  const auto whole = marker_set_labels("plug-in-gait"), lower = marker_set_labels("plug-in-gait-lower");
  EXPECT_TRUE(has(whole, "LFHD") && has(whole, "C7") && has(whole, "LKNE"));
  for (const char* label : {"LASI", "RPSI", "SACR", "LTHI", "RKNE", "LTIB", "RANK", "LHEE", "RTOE"})
    EXPECT_TRUE(has(lower, label)) << label;
  EXPECT_FALSE(has(lower, "LFHD") || has(lower, "C7") || has(lower, "LSHO"));
  EXPECT_TRUE(has(marker_set_labels("helen-hayes-lower"), "V.Sacral"));
  try {
    marker_set_labels("plugin");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("there are plug-in-gait, plug-in-gait-lower, cmu-41"), std::string::npos)
        << error.what();
  }
}

TEST(BodyMarkerSets, EveryLabelHasASideAndComesBack) {
  const BodyMarkerSet& cmu = body_marker_set("cmu-41");
  EXPECT_EQ(cmu.size(), 41u);
  EXPECT_EQ(cmu.key_of("LFWT"), "LASI");
  EXPECT_EQ(cmu.key_of("RMT5"), "RMT5");
  EXPECT_EQ(cmu.key_of("LASI"), std::nullopt);
  EXPECT_EQ(cmu.label_of("RTIB"), "RSHN");
  EXPECT_EQ(cmu.segment_of("LTIB"), SegmentId::left_shank);
  EXPECT_EQ(cmu.segment_of("RTIB"), SegmentId::right_shank);
  EXPECT_EQ(cmu.segment_of("RFHD"), SegmentId::head) << "the middle has no sides";
  EXPECT_EQ(cmu.segment_of("RSHO"), SegmentId::right_clavicle);
  const BodyMarkerSet& cleveland = body_marker_set("cleveland-clinic");
  EXPECT_EQ(cleveland.segment_of("R.Thigh.Rear"), SegmentId::right_thigh);
  EXPECT_FALSE(body_marker_set("helen-hayes").has("R.Thigh.Rear"));
}

TEST(BodyMarkerSets, SaysWhatLacks) {
  Labels labels = labels_of(body_marker_set("cmu-41"));
  labels.erase("LSHN");
  labels.erase("RKNE");
  try {
    recognised_marker_set(labels);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("CMU's 41 markers is nearest, and lacks RKNE, LSHN"), std::string::npos)
        << error.what();
  }
  EXPECT_THROW(body_marker_set("golem"), Error);
  EXPECT_NO_THROW(recognised_marker_set(labels_of(plug_in_gait())));
}

}  // namespace
}  // namespace marey::analyse::gait

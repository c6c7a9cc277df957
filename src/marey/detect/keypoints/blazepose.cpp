#include "marey/detect/keypoints/blazepose.h"

#include <algorithm>

namespace marey::detect::keypoints {
namespace {

KeypointSet make_blazepose() {
  KeypointSet set;
  set.name = "blazepose";
  set.points = {
      "nose",        "left_eye_inner", "left_eye",    "left_eye_outer",  "right_eye_inner", "right_eye",      "right_eye_outer",
      "left_ear",    "right_ear",      "left_mouth",  "right_mouth",     "left_shoulder",   "right_shoulder", "left_elbow",
      "right_elbow", "left_wrist",     "right_wrist", "left_pinky",      "right_pinky",     "left_index",     "right_index",
      "left_thumb",  "right_thumb",    "left_hip",    "right_hip",       "left_knee",       "right_knee",     "left_ankle",
      "right_ankle", "left_heel",      "right_heel",  "left_foot_index", "right_foot_index"};
  set.bones = {{0, 1},   {1, 2},   {2, 3},   {3, 7},   {0, 4},   {4, 5},   {5, 6},   {6, 8},   {9, 10},
               {11, 12}, {11, 13}, {13, 15}, {15, 17}, {15, 19}, {15, 21}, {17, 19}, {12, 14}, {14, 16},
               {16, 18}, {16, 20}, {16, 22}, {18, 20}, {11, 23}, {12, 24}, {23, 24}, {23, 25}, {24, 26},
               {25, 27}, {26, 28}, {27, 29}, {28, 30}, {27, 31}, {28, 32}, {29, 31}, {30, 32}};
  for (int i = 0; i < static_cast<int>(set.points.size()); ++i) {
    std::string other = set.points[static_cast<std::size_t>(i)];
    if (other.starts_with("left_")) {
      other = "right_" + other.substr(5);
    } else if (other.starts_with("right_")) {
      other = "left_" + other.substr(6);
    }
    set.mirrored.push_back(static_cast<int>(std::find(set.points.begin(), set.points.end(), other) - set.points.begin()));
  }
  return set;
}

}  // namespace

const KeypointSet& blazepose() {
  static const KeypointSet set = make_blazepose();
  return set;
}

}  // namespace marey::detect::keypoints

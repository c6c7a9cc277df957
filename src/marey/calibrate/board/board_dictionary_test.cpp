#include "marey/calibrate/board/board_dictionary.h"

#include <gtest/gtest.h>

#include "marey/calibrate/board/board.h"

namespace marey::calibrate::board {
namespace {

TEST(BoardDictionary, SizesAreThoseOfTheDictionaries) {
  const auto names = board_dictionaries();
  EXPECT_EQ(names.size(), 21U);
  for (const std::string& name : names) {
    const auto size = board_dictionary_size(name);
    ASSERT_TRUE(size) << name;
    EXPECT_EQ(board_dictionary(name)->bytesList.rows, *size) << name;
  }
}

TEST(BoardDictionary, TheNameTellsTheSquaresOfAMarker) {
  EXPECT_EQ(board_dictionary("4X4_50")->markerSize, 4);
  EXPECT_EQ(board_dictionary("7X7_1000")->markerSize, 7);
  EXPECT_EQ(board_dictionary("APRILTAG_36H11")->markerSize, 6);
}

TEST(BoardDictionary, AnUnknownNameHasNone) {
  for (const char* name : {"", "4x4_50", "8X8_50", "4X4_50 "}) EXPECT_FALSE(board_dictionary_size(name)) << name;
}

}  // namespace
}  // namespace marey::calibrate::board

#include "marey/detect/background.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

TEST(BackgroundRegister, KnowsItsModelsByName) {
  EXPECT_EQ(background_names(), "marey, mog2, knn");
  EXPECT_TRUE(std::holds_alternative<KnnOptions>(parse_background("knn")));
  try {
    parse_background("magic");
    FAIL() << "an unknown name must be refused";
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "there is no background model \"magic\"; choose one of: marey, mog2, knn");
  }
}

}  // namespace
}  // namespace marey

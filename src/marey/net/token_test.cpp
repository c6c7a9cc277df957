#include "marey/net/token.h"

#include <gtest/gtest.h>

namespace marey::net {
namespace {

TEST(Token, IsAnotherOneEachTime) {
  const std::string one = new_token();
  EXPECT_EQ(one.size(), 48U);
  EXPECT_EQ(one.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(one, new_token());
  EXPECT_TRUE(same_secret(one, std::string(one)));
  EXPECT_FALSE(same_secret(one, one.substr(1)));
  EXPECT_FALSE(same_secret(one, new_token()));
}

TEST(Token, TargetsAreTakenApart) {
  EXPECT_EQ(path_of("/scene?n=3"), "/scene");
  EXPECT_EQ(path_of("/scene"), "/scene");
  EXPECT_EQ(query_value("/a?n=3&m=4", "m"), "4");
  EXPECT_EQ(query_value("/a?nm=3", "n"), "");
  EXPECT_EQ(query_value("/a", "n"), "");
}

}  // namespace
}  // namespace marey::net

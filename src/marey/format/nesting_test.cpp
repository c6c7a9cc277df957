#include "marey/format/nesting.h"

#include <string>
#include <utility>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format {
namespace {

std::string times(std::string_view text, int count, std::string before = "") {
  std::string result = std::move(before);
  for (int i = 0; i < count; ++i) result += text;
  return result;
}

bool passes(const std::string& text, Notation notation) {
  try {
    check_nesting(text, notation, "file");
    return true;
  } catch (const Error& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("file:")) << error.what();
    return false;
  }
}

constexpr int kMany = 200'000;

TEST(Nesting, TheLimitItselfPassesAndOneMoreDoesNot) {
  for (const int depth : {kMaxNestingDepth, kMaxNestingDepth + 1}) {
    const bool required = depth == kMaxNestingDepth;
    EXPECT_EQ(passes(times("[", depth) + times("]", depth), Notation::json), required) << depth;
    EXPECT_EQ(passes(times("[", depth, "a = ") + times("]", depth), Notation::toml), required) << depth;
    EXPECT_EQ(passes(times("<a>", depth) + times("</a>", depth), Notation::xml), required) << depth;
  }
}

TEST(Nesting, ABinaryFileIsNamedAsOne) {
  for (const Notation notation : {Notation::json, Notation::toml, Notation::xml})
    EXPECT_FALSE(passes(std::string(3, '\0'), notation));
  EXPECT_TRUE(is_binary(std::string("a\0b", 3)));
  EXPECT_FALSE(is_binary("a = 1\n"));
}

TEST(Nesting, EachWayToNestIsSeen) {
  EXPECT_FALSE(passes(times(".a", kMany, "a") + " = 1", Notation::toml));
  EXPECT_FALSE(passes(times(".\"b.c\"", kMany, "[a") + "]", Notation::toml));
  EXPECT_FALSE(passes(times("{a=", kMany, "x = "), Notation::toml));
  EXPECT_FALSE(passes(times("{a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a.a=", 10, "x = "), Notation::toml));
  EXPECT_FALSE(passes(times("[{\"a\":", kMany), Notation::json));
  EXPECT_FALSE(passes(times("<a b='/>'>", kMany), Notation::xml));
  EXPECT_FALSE(passes(times("<a", kMany), Notation::xml));
}

TEST(Nesting, IgnoresBracketsInStringsAndComments) {
  EXPECT_FALSE(passes(times("[\"]\",", kMany), Notation::json));
  EXPECT_FALSE(passes(times("[ # ]\n", kMany, "x = "), Notation::toml));
  EXPECT_FALSE(passes(times("[ ']', ", kMany, "x = "), Notation::toml));
  EXPECT_FALSE(passes(times("<a><!-- </a> -->", kMany), Notation::xml));
}

TEST(Nesting, LongFlatTextsPass) {
  EXPECT_TRUE(passes(times("1.5, ", kMany, "x = [") + "]\n" + times("[[camera]]\nfocal = [1.0, 2.0]\n", 1000), Notation::toml));
  EXPECT_TRUE(passes(times("[.", kMany, "x = \"") + "\"", Notation::toml));
  EXPECT_TRUE(passes(times("[.\n", kMany, "x = \"\"\"") + "\"\"\"", Notation::toml));
  EXPECT_TRUE(passes(times("{\"a\": \"[[\"},", kMany, "[") + "]", Notation::json));
  EXPECT_TRUE(passes(times("<b c='1'/>text<b></b>", kMany, "<a>") + "</a>", Notation::xml));
}

TEST(Nesting, TheMessageNamesTheLine) {
  try {
    check_nesting(times("[", kMany, "a = 1\n\nb = "), Notation::toml, "rig.toml");
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), fmt::format("rig.toml:3: is nested more than {} deep, as no file of its kind is; it must be damaged",
                                           kMaxNestingDepth)
                                   .c_str());
  }
}

}  // namespace
}  // namespace marey::format

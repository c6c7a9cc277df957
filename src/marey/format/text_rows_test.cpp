#include "marey/format/text_rows.h"

#include <gtest/gtest.h>

namespace marey::format {
namespace {

TEST(TextRows, EscapesFormulasAndReadsThemBack) {
  for (const std::string text : {"=1+1", "+cmd", "-x", "@SUM(A1)", "=\"a\",b", "'=x", "''-x"}) {
    const std::string field = quoted_field(text);
    EXPECT_TRUE(field.starts_with('\'') || field.starts_with("\"'")) << field;
    EXPECT_EQ(unquoted(field), text);
  }
}

TEST(TextRows, OtherTextsAndNumbersStay) {
  for (const std::string text : {"left knee", "-5", "+1.5e3", "7", "O'Neill", "'s", "", "a=b"}) {
    EXPECT_EQ(quoted_field(text), text);
    EXPECT_EQ(unquoted(text), text);
  }
}

TEST(TextRows, FieldsArePlainText) {
  EXPECT_EQ(quoted_field("a\x01,\"\n"), "\"a\xEF\xBF\xBD,\"\" \"");
}

}  // namespace
}  // namespace marey::format

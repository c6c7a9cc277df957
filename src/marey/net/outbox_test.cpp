#include "marey/net/outbox.h"

#include <gtest/gtest.h>

namespace marey::net {
namespace {

Outbox::Message bytes(const std::string& text) {
  return {.body = std::make_shared<const std::string>(text)};
}

/// All that goes out from now on, in order.
std::string all_of(Outbox& out) {
  std::string all;
  while (const Outbox::Message* next = out.begin_next()) {
    all += next->head;
    all += next->body_bytes();
    out.done();
  }
  return all;
}

TEST(Outbox, DropsTheOldestFrameThatWasNotBegun) {
  Outbox out;
  for (const char* each : {"1", "2"}) out.frame(bytes(each));
  ASSERT_NE(out.begin_next(), nullptr);
  for (const char* each : {"3", "4", "5", "6"}) out.frame(bytes(each));
  EXPECT_EQ(out.frames_dropped(), 2);
  EXPECT_EQ(all_of(out), "1456");
  EXPECT_EQ(out.frames_sent(), 4);
  EXPECT_TRUE(out.is_empty());
}

TEST(Outbox, KeepsAnswersInTheirOrderAmongFrames) {
  Outbox out;
  out.frame(bytes("1"));
  out.answer("a");
  for (const char* each : {"2", "3", "4", "5"}) out.frame(bytes(each));
  out.answer("b");
  EXPECT_EQ(all_of(out), "a2345b");
}

TEST(Outbox, GivesEachTopicOnePlaceAndItsTurn) {
  Outbox out;
  out.frame_of_topic(1, bytes("old"));
  out.frame_of_topic(2, bytes("picture"));
  out.frame_of_topic(1, bytes("new"));
  EXPECT_EQ(out.frames_dropped(), 1);
  ASSERT_EQ(out.begin_next()->body_bytes(), "new") << "a fast topic does not lose its turn";
  out.frame_of_topic(1, bytes("newer"));
  EXPECT_EQ(all_of(out), "newpicturenewer");
}

TEST(Outbox, CountsAnswersThatAreNotRead) {
  Outbox out;
  out.answer(std::string(Outbox::kMaxUnread, 'x'));
  EXPECT_FALSE(out.is_overfull());
  out.answer("y");
  EXPECT_TRUE(out.is_overfull());
  out.begin_next();
  out.done();
  EXPECT_FALSE(out.is_overfull());
}

TEST(Outbox, TakesNothingAfterItsEnd) {
  Outbox out;
  int changes = 0;
  out.on_change([&] { ++changes; });
  out.answer("bye");
  out.end();
  out.frame(bytes("1"));
  out.frame_of_topic(1, bytes("2"));
  EXPECT_EQ(changes, 2);
  EXPECT_TRUE(out.is_ending());
  EXPECT_EQ(all_of(out), "bye");
  out.discard();
  out.answer("late");
  EXPECT_EQ(all_of(out), "");
}

}  // namespace
}  // namespace marey::net

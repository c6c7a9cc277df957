#include "marey/source/read_ahead.h"

#include <atomic>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::source {
namespace {

/// Frames numbered from 0; reports how many were requested, and fails after `fails_after` where that is given.
class Numbers final : public Source {
 public:
  Numbers(int count, std::atomic<int>* requested, int fails_after = -1)
      : count_(count), requested_(requested), fails_after_(fails_after) {
    info_.name = "numbers";
  }
  const SourceInfo& info() const override { return info_; }
  std::optional<Frame> next() override {
    if (at_ == fails_after_) throw Error("numbers: the line was cut");
    if (at_ == count_) return std::nullopt;
    ++*requested_;
    Frame frame;
    frame.index = at_++;
    return frame;
  }
  std::vector<std::string> warnings() const override { return {std::to_string(at_)}; }

 private:
  SourceInfo info_;
  int count_, at_ = 0;
  std::atomic<int>* requested_;
  int fails_after_;
};

TEST(ReadAhead, GivesTheSameFramesInTheSameOrder) {
  std::atomic<int> requested = 0;
  const auto source = read_ahead(std::make_unique<Numbers>(500, &requested), 4);
  EXPECT_EQ(source->info().name, "numbers");
  for (int i = 0; i < 500; ++i) {
    const auto frame = source->next();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->index, i);
  }
  EXPECT_FALSE(source->next());
  EXPECT_FALSE(source->next());
  EXPECT_EQ(source->warnings().front(), "500");
}

TEST(ReadAhead, NeverHoldsMoreThanItsDepth) {
  std::atomic<int> requested = 0;
  const auto source = read_ahead(std::make_unique<Numbers>(500, &requested), 4);
  for (int i = 1; i <= 50; ++i) {
    source->next();
    std::this_thread::yield();
    EXPECT_LE(requested, i + 4 + 1) << "one may be in the reader's hand";
  }
}

TEST(ReadAhead, MayBeLeftAtAnyTime) {
  for (int read = 0; read < 20; ++read) {
    std::atomic<int> requested = 0;
    const auto source = read_ahead(std::make_unique<Numbers>(15, &requested), 3);
    for (int i = 0; i < read; ++i) source->next();
    source->warnings();
  }
}

TEST(ReadAhead, AFailureReachesTheReader) {
  std::atomic<int> requested = 0;
  const auto source = read_ahead(std::make_unique<Numbers>(10, &requested, 3), 2);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(source->next());
  EXPECT_THROW(source->next(), Error);
  EXPECT_FALSE(source->next());
}

}  // namespace
}  // namespace marey::source

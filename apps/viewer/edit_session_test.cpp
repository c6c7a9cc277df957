#include "edit_session.h"

#include <chrono>
#include <condition_variable>
#include <fstream>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/edit/edited.h"
#include "marey/format/take/take_file.h"
#include "marey/pipeline/take/edit_take.h"

#include "support/files.h"

namespace marey::viewer {
namespace {

constexpr int kEditedFrames = 300;

/// Tracks 1, 2 and 3, called A, B and C, each at x = its number; C is not there in frames 50 to 54. And a body, of which
/// another pose is in question in frames 100 to 199.
Recording letters_and_a_body() {
  RecordingHeader header;
  header.rate_hz = 100;
  header.bodies.emplace_back();
  header.bodies.back().id = BodyId{1};
  header.bodies.back().label = "box";
  Recording recording(header);
  for (int track = 1; track <= 3; ++track)
    recording.set_name({.id = TrackId{track}, .label = std::string(1, static_cast<char>('A' + track - 1)), .team = {}});
  for (int frame = 0; frame < kEditedFrames; ++frame) {
    Instant instant;
    instant.index = frame;
    instant.time = timestamp_from_seconds(0.01 * frame);
    for (int track = 1; track <= 3; ++track) {
      if (track == 3 && frame >= 50 && frame < 55) continue;
      instant.samples.emplace_back();
      instant.samples.back().track = TrackId{track};
      instant.samples.back().position = Vector<3>(track, 0.01 * frame, 0);
    }
    instant.bodies.emplace_back();
    instant.bodies.back().body = BodyId{1};
    instant.bodies.back().world_from_body = {Eigen::AngleAxisd(0.01 * frame, Vector<3>::UnitX()).toRotationMatrix(), {0, 0, 1}};
    if (frame >= 100 && frame < 200)
      instant.bodies.back().other = OtherPose{.world_from_body = {Matrix<3>::Identity(), {0, 0.1, 1}}, .probability = 0.4};
    recording.add(instant);
  }
  return recording;
}

/// A take that is shown and edited.
class EditedTake : public testing::Test {
 protected:
  EditedTake() : recorded_(letters_and_a_body()), stored_(recorded_.header, {}) {
    format::take::write_recording(path_, recorded_);
    session_ = std::make_unique<EditSession>(
        path_, stored_,
        EditSession::Answers{.answer = [this](PageId, std::string line) { received(std::move(line)); }, .changed = [] {}});
  }
  ~EditedTake() override { session_->end(); }

  void show() {
    InstantsOf instants(recorded_);
    while (const auto instant = instants.next()) stored_.add(*instant);
    stored_.finish({});
    before_ = bytes();
    session_->begin();
  }
  std::string requested(const std::string& line) {
    std::unique_lock lock(mutex_);
    answer_.clear();
    lock.unlock();
    session_->request(PageId{1}, line);
    lock.lock();
    answered_.wait_for(lock, std::chrono::seconds(60), [this] { return !answer_.empty(); });
    return answer_;
  }
  std::vector<std::string> bytes() const {
    std::vector<std::string> all;
    for (std::size_t n = 0; stored_.segment(n) != nullptr; ++n) all.push_back(*stored_.segment(n));
    return all;
  }
  std::vector<int> versions() const {
    std::vector<int> all;
    for (const RecordingState::TimeChunk& segment : stored_.state().segments) all.push_back(segment.version);
    return all;
  }
  /// As a viewer shows the take that is opened now.
  std::vector<std::string> bytes_again() const {
    const Recording now = edit::edited(format::take::read_recording(path_));
    StoredRecording fresh(now.header, {});
    InstantsOf instants(now);
    while (const auto instant = instants.next()) fresh.add(*instant);
    fresh.finish({});
    std::vector<std::string> all;
    for (std::size_t n = 0; fresh.segment(n) != nullptr; ++n) all.push_back(*fresh.segment(n));
    return all;
  }

  test::TemporaryFolder folder_;
  std::string path_ = folder_ / "letters.marey";
  Recording recorded_;
  StoredRecording stored_;
  std::unique_ptr<EditSession> session_;
  std::vector<std::string> before_;

 private:
  void received(std::string line) {
    const std::lock_guard lock(mutex_);
    answer_ = std::move(line);
    answered_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable answered_;
  std::string answer_;
};

TEST(EditMessage, IsOneOfFourAndNothingElse) {
  const auto swap = edit_message("edit 3 5 swap \"L KNE\" RKNE 1:2");
  ASSERT_TRUE(swap);
  EXPECT_EQ(swap->on, (pipeline::take::EditState{.head = 3, .newest = 5}));
  EXPECT_EQ(swap->text, "swap \"L KNE\" RKNE 1:2");
  EXPECT_EQ(edit_message("go 3 5 0")->to, 0);
  EXPECT_EQ(edit_message("undo 0 0")->kind, EditMessage::Kind::undo);
  EXPECT_EQ(edit_message("redo 1 2")->kind, EditMessage::Kind::redo);
  for (const std::string wrong :
       {"", " ", "edit", "edit 1", "edit 1 2", "edit 1 2 ", "edit -1 2 fill all", "edit 1 99999999999999999999 fill all",
        "edit x y z", "undo", "undo 1", "undo 1 2 3", "go 1 2", "go 1 2 -3", "go 1 2 3 4", "Edit 1 2 fill all", "edit1 2 fill all"})
    EXPECT_FALSE(edit_message(wrong)) << wrong;
  EXPECT_FALSE(edit_message(std::string(4096, '9')));
  EXPECT_FALSE(edit_message(std::string("undo 1 2\0", 9)));
  EXPECT_TRUE(queries_for_edit("edit what"));
  EXPECT_FALSE(queries_for_edit("video 1 640"));
}

TEST_F(EditedTake, ShowsWhatTheTakeIsAfterEachEdit) {
  show();
  EXPECT_EQ(before_, bytes_again());
  int newest = 0;
  for (const char* edit : {"swap A B 120:180", "rename C knee", "fill knee", "split A 200 late", "delete B", "join A late",
                           "filter all 6", "delete knee 10:20"}) {
    EXPECT_EQ(requested("edit " + std::to_string(newest) + " " + std::to_string(newest) + " " + edit), "done") << edit;
    ++newest;
    EXPECT_EQ(bytes(), bytes_again()) << edit;
  }
  EXPECT_EQ(stored_.state().tracks.size(), 2U) << "B is deleted, late is joined";
  EXPECT_EQ(requested("undo 8 8"), "done");
  EXPECT_EQ(bytes(), bytes_again());
  EXPECT_EQ(requested("go 7 8 3"), "done");
  EXPECT_EQ(bytes(), bytes_again());
  EXPECT_EQ(requested("edit 3 8 rename A hip"), "done") << "a branch";
  EXPECT_EQ(requested("redo 9 9"), "refused " + path_ + ": there is nothing to be done again");
  EXPECT_EQ(requested("go 9 9 0"), "done");
  EXPECT_EQ(bytes(), before_);
}

TEST_F(EditedTake, ShowsATurnedBody) {
  show();
  EXPECT_EQ(requested("edit 0 0 turn box 120:150"), "done");
  EXPECT_NE(bytes(), before_);
  EXPECT_EQ(bytes(), bytes_again());
  EXPECT_EQ(versions(), (std::vector<int>{1, 1, 0})) << "only chunks with these frames";
  EXPECT_EQ(requested("edit 1 1 turn box"), "done") << "those of 120 to 150 are turned back";
  EXPECT_EQ(bytes(), bytes_again());
  EXPECT_EQ(requested("undo 2 2"), "done");
  EXPECT_EQ(bytes(), bytes_again());
  EXPECT_EQ(requested("undo 1 2"), "done");
  EXPECT_EQ(bytes(), before_);
}

TEST_F(EditedTake, OnlyStretchesThatAreOthersBecomeNew) {
  show();
  ASSERT_EQ(versions(), (std::vector{0, 0, 0}));
  EXPECT_EQ(requested("edit 0 0 swap A B 20:30"), "done");
  EXPECT_EQ(versions(), (std::vector{1, 0, 0}));
  EXPECT_EQ(requested("edit 1 1 rename A hip"), "done");
  EXPECT_EQ(versions(), (std::vector{1, 0, 0})) << "a name moves nothing";
  const auto tracks = stored_.state().tracks;
  EXPECT_EQ(tracks[0].name.label, "hip");
  EXPECT_EQ(tracks[0].version, 2);
  EXPECT_EQ(tracks[2].version, 0);
  EXPECT_EQ(tracks[1].rows, kEditedFrames);
  EXPECT_DOUBLE_EQ(tracks[1].last_s, 0.01 * (kEditedFrames - 1));
}

TEST_F(EditedTake, RefusesWithTheSentenceOfTheCommandLine) {
  EXPECT_EQ(requested("edit 0 0 fill all"), "refused the take is still being read; edit it when all of it is there");
  show();
  EXPECT_EQ(requested("edit"), "refused this is not an edit");
  for (const char* wrong : {"swap A no person", "jump A", "fill A", "rename A B", "delete A 10:9999"}) {
    std::string message_text;
    try {
      pipeline::take::edit_take(path_, {{.text = wrong, .where = std::string("\"") + wrong + "\""}});
    } catch (const Error& error) {
      message_text = error.what();
    }
    EXPECT_EQ(requested(std::string("edit 0 0 ") + wrong), "refused " + message_text);
  }
  EXPECT_EQ(requested("go 0 0 7"), "refused " + path_ + ": there is no edit 7; `marey edit FILE --list` shows which there are");
  EXPECT_EQ(bytes(), before_);
  EXPECT_EQ(pipeline::take::edit_history(path_).state, pipeline::take::EditState{});
}

TEST_F(EditedTake, KeepsEditsOfOtherPrograms) {
  show();
  EXPECT_EQ(requested("edit 0 0 rename A hip"), "done");
  pipeline::take::edit_take(path_, {{.text = "rename B knee", .where = "elsewhere"}});
  for (const char* blind : {"edit 1 1 swap #1 #2", "undo 1 1", "go 1 1 0"}) {
    const std::string answer = requested(blind);
    EXPECT_NE(answer.find("another program has edited it in the meantime"), std::string::npos) << answer;
  }
  EXPECT_EQ(pipeline::take::edit_history(path_).counting, (std::vector<std::int64_t>{1, 2}));
  EXPECT_EQ(stored_.state().tracks[1].name.label, "knee") << "it is shown";
  EXPECT_EQ(requested("edit 2 2 swap hip knee"), "done");
  EXPECT_EQ(bytes(), bytes_again());
}

TEST_F(EditedTake, TheHistoryIsTold) {
  show();
  EXPECT_EQ(requested("edit 0 0 rename C knee"), "done");
  EXPECT_EQ(requested("edit 1 1 fill knee"), "done");
  EXPECT_EQ(requested("undo 2 2"), "done");
  EXPECT_EQ(requested("undo 1 2"), "done");
  const std::string history = *session_->history();
  EXPECT_NE(history.find(R"("description":"rename C to knee")"), std::string::npos) << history;
  EXPECT_NE(history.find(R"("description":"fill knee: 1 gap, 5 frames)"), std::string::npos) << history;
  EXPECT_NE(history.find(R"("head":0)"), std::string::npos) << history;
  EXPECT_NE(history.find(R"("newest":2)"), std::string::npos) << history;
}

TEST(EditSession, OnlyATakeCanBeEdited) {
  const test::TemporaryFolder folder;
  const std::string path = folder / "walk.csv";
  std::ofstream(path) << "frame,time,id,label,x,y,z\n";
  StoredRecording stored(RecordingHeader{}, {});
  EXPECT_THROW(EditSession(path, stored, {.answer = [](PageId, const std::string&) {}, .changed = [] {}}), Error);
}

}  // namespace
}  // namespace marey::viewer

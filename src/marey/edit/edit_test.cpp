#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/edit/decide.h"
#include "marey/edit/edited.h"
#include "marey/edit/history.h"
#include "marey/edit/tracks.h"
#include "marey/edit/turn_body.h"

namespace marey::edit {
namespace {

/// Tracks 1, 2, … called A, B, …, each at x = its number, y = the frame, in frames 0 to `frames` − 1.
Recording letters(int tracks, int frames) {
  RecordingHeader header;
  header.name = "letters";
  header.rate_hz = 100;
  Recording recording(header);
  for (int track = 1; track <= tracks; ++track)
    recording.set_name({.id = TrackId{track}, .label = std::string(1, static_cast<char>('A' + track - 1)), .team = {}});
  for (int frame = 0; frame < frames; ++frame) {
    Instant instant;
    instant.index = frame;
    instant.time = timestamp_from_seconds(0.01 * frame);
    for (int track = 1; track <= tracks; ++track) {
      instant.samples.emplace_back();
      instant.samples.back().track = TrackId{track};
      instant.samples.back().position = Vector<3>(track, frame, 0);
    }
    recording.add(instant);
  }
  return recording;
}

void edit(Recording& recording, const std::string& text) {
  Recording now = edited(recording);
  std::vector<TrackName> names;
  for (const TrackColumns& track : now.tracks()) names.push_back(track.name);
  Tracks tracks(now.instants(), names, [&](TrackId track) { return *now.find(track); });
  const Operation operation = decide(parse_request(text), tracks);
  tracks.apply(operation);
  Edit done = edit_of(operation);
  done.id = next_id(recording.edits);
  done.parent = recording.head;
  recording.head = done.id;
  recording.edits.push_back(done);
}

std::string error_of(Recording recording, const std::string& text) {
  try {
    edit(recording, text);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

/// "A:111222" says whose place, by x, the track called A has in each frame, and "." where it has none.
std::string image(const Recording& recording) {
  std::string all;
  for (const TrackColumns& track : recording.tracks()) {
    std::string row(recording.instants().size(), '.');
    for (std::size_t i = 0; i < track.size(); ++i)
      row[static_cast<std::size_t>(track.at()[i])] = static_cast<char>('0' + static_cast<int>(track.x()[i]));
    all += fmt::format("{}:{} ", track.name.label, row);
  }
  return all;
}

TEST(Edit, SwapExchangesWhatLiesInTheFrames) {
  Recording recording = letters(2, 6);
  edit(recording, "swap A B 2:3");
  EXPECT_EQ(image(edited(recording)), "A:112211 B:221122 ");
  EXPECT_EQ(image(recording), "A:111111 B:222222 ") << "what was recorded is as it was";
}

TEST(Edit, SwapOfOneThatIsNotThere) {
  Recording recording = letters(2, 6);
  edit(recording, "delete B 2:5");
  edit(recording, "swap A B 1:3");
  EXPECT_EQ(image(edited(recording)), "A:12..11 B:2111.. ");
}

TEST(Edit, SplitJoinRenameDelete) {
  Recording recording = letters(2, 6);
  edit(recording, "split A 4 \"A two\"");
  edit(recording, "delete B 3:");
  EXPECT_EQ(image(edited(recording)), "A:1111.. B:222... A two:....11 ");
  edit(recording, "join B \"A two\"");
  edit(recording, "rename B \"one, two\"");
  EXPECT_EQ(image(edited(recording)), "A:1111.. one, two:222.11 ");
  edit(recording, "delete \"one, two\"");
  EXPECT_EQ(image(edited(recording)), "A:1111.. ");
}

/// The result when a fill was decided stays with the edit: code that then needs one track reads that one alone.
TEST(Edit, FillsKeepTheirPlaces) {
  Recording recording = letters(4, 60);
  edit(recording, "delete A 20:22");
  edit(recording, "delete B 40:43");
  edit(recording, "fill all");
  const Recording whole = edited(recording);
  std::vector<TrackName> names;
  for (const TrackColumns& track : recording.tracks()) names.push_back(track.name);
  std::vector<TrackId> read;
  Tracks tracks(recording.instants(), names, [&](TrackId track) {
    read.push_back(track);
    return *recording.find(track);
  });
  for (const Edit& one : recording.edits) {
    const Operation operation = operation_of(one).value();
    if (operation.kind == Operation::Kind::fill) {
      EXPECT_EQ(read, (std::vector{TrackId{1}, TrackId{2}}));
      ASSERT_EQ(operation.gaps.size(), 2U);
      EXPECT_EQ(operation.gaps[1].locations.size(), 4U);
    }
    tracks.apply(operation);
  }
  EXPECT_EQ(tracks.rows(TrackId{1}).size(), 60U);
  EXPECT_EQ(read.size(), 2U) << "the others were not required";
  for (const TrackId track : {TrackId{1}, TrackId{2}}) {
    const TrackColumns now = tracks.columns(track, 3);
    for (std::size_t row = 0; row < 60; ++row) EXPECT_EQ(now.sample(row).position, whole.find(track)->sample(row).position);
  }
  // Edits of before have no places: they are found again, and are the same.
  Recording older = recording;
  for (Edit& one : older.edits) {
    Operation operation = operation_of(one).value();
    for (FilledGap& gap : operation.gaps) gap.locations.clear();
    one.payload = edit_of(operation).payload;
  }
  const Recording again = edited(older);
  for (std::size_t row = 0; row < 60; ++row) {
    EXPECT_EQ(again.find(TrackId{1})->sample(row).position, whole.find(TrackId{1})->sample(row).position);
    EXPECT_EQ(again.find(TrackId{2})->sample(row).position, whole.find(TrackId{2})->sample(row).position);
  }
  Operation damaged = operation_of(recording.edits.back()).value();
  damaged.gaps.front().locations.pop_back();
  recording.edits.back().payload = edit_of(damaged).payload;
  EXPECT_THROW(edited(recording), Error);
}

TEST(Edit, TeamsAreGivenAndGoAlong) {
  Recording recording = letters(3, 6);
  edit(recording, "team A,C \"Real, Madrid\"");
  edit(recording, "split C 3 D");
  std::string teams;
  const Recording now = edited(recording);
  for (const TrackColumns& track : now.tracks()) teams += track.name.label + ":" + track.name.team + " ";
  EXPECT_EQ(teams, "A:Real, Madrid B: C:Real, Madrid D:Real, Madrid ");
  EXPECT_EQ(error_of(recording, "team A"), "team: its new name is missing");
  EXPECT_EQ(error_of(recording, "team X Reds"), "there is no track called \"X\"");
}

TEST(Edit, PiecesOfOneMarkerMayShareItsName) {
  Recording recording = letters(2, 6);
  edit(recording, "delete A 3:");
  EXPECT_EQ(error_of(recording, "delete A 4:5"), "delete: nothing is there in frames 4 to 5");
  EXPECT_NE(error_of(recording, "split B 2 A"), "") << "both are there in frame 2";
  edit(recording, "split B 3 A");
  EXPECT_EQ(image(edited(recording)), "A:111... B:222... A:...222 ");
}

TEST(Edit, UndoRedoAndBranches) {
  Recording recording = letters(2, 3);
  edit(recording, "rename A C");
  edit(recording, "rename C D");
  recording.head = undone(recording.edits, recording.head, 1);
  EXPECT_EQ(image(edited(recording)), "C:111 B:222 ");
  edit(recording, "rename B E");  // another branch: nothing of the first is lost
  EXPECT_EQ(image(edited(recording)), "C:111 E:222 ");
  recording.head = undone(recording.edits, recording.head, 9);
  EXPECT_FALSE(recording.head);
  EXPECT_EQ(redone(recording.edits, recording.head, 9), 3);
  recording.head = 2;
  EXPECT_EQ(image(edited(recording)), "D:111 B:222 ");
}

TEST(Edit, ReportsImpossibleEdit) {
  const Recording recording = letters(3, 6);
  EXPECT_EQ(error_of(recording, "swp A B"),
            "\"swp\" is not an edit; rename, swap, split, join, delete, fill, filter, team and turn are known");
  EXPECT_EQ(error_of(recording, "swap A X"), "there is no track called \"X\"");
  EXPECT_EQ(error_of(recording, "swap A A"), "swap: \"A\" is named twice");
  EXPECT_EQ(error_of(recording, "swap A"), "swap: the second track is missing");
  EXPECT_EQ(error_of(recording, "swap A B 5:2"), "\"5:2\" are not frames; write FIRST:LAST, counted from 0");
  EXPECT_EQ(error_of(recording, "swap A B 1:2 C"), "swap: \"C\" is too much");
  EXPECT_EQ(error_of(recording, "join A B"), "\"A\" and \"B\" are both there in frame 0; split or delete one of them first");
  EXPECT_EQ(error_of(recording, "delete A 3:200"), "delete: frame 200 is named, and the last one is 5");
  EXPECT_EQ(error_of(recording, "split A 6"), "split: frame 6 is named, and the last one is 5");
  EXPECT_EQ(error_of(recording, "rename A C"),
            "rename: #3 is called \"C\" already and is there at the same time, as in frame 0; rename, join or delete it first");
  EXPECT_EQ(error_of(recording, "rename #7 B"), "there is no track #7");
  EXPECT_EQ(error_of(recording, "rename \"A B"), "a name begins with \" and does not end");
  EXPECT_EQ(error_of(recording, "filter A -3"), "filter: \"-3\" is not a cut-off; it is in Hz, above 0, or auto");
  EXPECT_EQ(error_of(recording, "filter A 500"),
            "filter: at 100 frames a second a cut-off of 500 Hz would change nothing; it lies below 40.1 Hz");
  EXPECT_EQ(error_of(recording, "filter A 41"),
            "filter: at 100 frames a second a cut-off of 41 Hz would change nothing; it lies below 40.1 Hz");
  EXPECT_EQ(error_of(recording, "fill A"), "fill: there is no gap to fill");
  EXPECT_EQ(error_of(recording, ""), "an edit is empty; rename, swap, split, join, delete, fill, filter, team and turn are known");
}

TEST(Edit, AnOperationSurvivesItsText) {
  const Operation operation{.kind = Operation::Kind::fill,
                            .gaps = {{TrackId{3}, {4, 9}, FillMethod::rigid, {TrackId{1}, TrackId{2}}, 0.25},
                                     {TrackId{3}, {40, 41}, FillMethod::spline, {}, 1e-3}}};
  EXPECT_EQ(operation_of(edit_of(operation)), operation);
  EXPECT_FALSE(operation_of({.id = 1, .parent = {}, .operation = "note", .payload = "x"}));
  EXPECT_FALSE(operation_of({.id = 1, .parent = {}, .operation = "stretch", .payload = "{}"}));
  for (const char* payload : {"", "[]", "{", "{\"tracks\":[1]}", "{\"tracks\":[1,-2]}", "{\"tracks\":[1,2],\"frames\":[3]}",
                              "{\"tracks\":[1,2],\"frames\":[3,2]}", "{\"tracks\":\"x\"}"})
    EXPECT_THROW(operation_of({.id = 1, .parent = {}, .operation = "swap", .payload = payload}), Error) << payload;
}

TEST(Edit, AHeadOrAParentThatIsNotThere) {
  EXPECT_THROW(branch_of({}, 3), Error);
  EXPECT_THROW(branch_of({{.id = 1, .parent = 2, .operation = "note", .payload = {}},
                          {.id = 2, .parent = 1, .operation = "note", .payload = {}}},
                         2),
               Error);
}

/// The slow twin: a table of frames × tracks, without ranges of rows.
struct Table {
  std::vector<std::vector<int>> x;  // by track, by frame; 0: none
  std::string image() const {
    std::string all;
    for (std::size_t track = 0; track < x.size(); ++track) {
      std::string row;
      bool any = false;
      for (const int value : x[track]) {
        row += value == 0 ? '.' : static_cast<char>('0' + value);
        any |= value != 0;
      }
      if (any) all += fmt::format("{}:{} ", static_cast<char>('A' + track), row);
    }
    return all;
  }
};

TEST(Edit, ManyRandomEditsLeaveWhatASlowTableLeavesAndAreUndone) {
  const unsigned seed = std::random_device()();
  SCOPED_TRACE(fmt::format("seed {}", seed));
  std::mt19937 random(seed);
  constexpr int kTracks = 4, kFrames = 40;
  Recording recording = letters(kTracks, kFrames);
  const std::string before = image(edited(recording));
  Table table{std::vector(kTracks, std::vector<int>(kFrames))};
  for (int track = 0; track < kTracks; ++track)
    std::fill(table.x[static_cast<std::size_t>(track)].begin(), table.x[static_cast<std::size_t>(track)].end(), track + 1);
  const auto any = [&](int below) { return static_cast<int>(random() % static_cast<unsigned>(below)); };
  for (int i = 0; i < 200; ++i) {
    const int a = any(kTracks), b = (a + 1 + any(kTracks - 1)) % kTracks, first = any(kFrames), last = first + any(kFrames - first);
    const bool remove = any(4) == 0;
    const char mine_called = static_cast<char>('A' + a), other_called = static_cast<char>('A' + b);
    const int end = remove ? std::min(last, first + 1) : last;
    const std::string text = remove ? fmt::format("delete {} {}:{}", mine_called, first, end)
                                    : fmt::format("swap {} {} {}:{}", mine_called, other_called, first, end);
    try {
      edit(recording, text);
    } catch (const Error&) {
      continue;  // nothing there
    }
    for (int frame = first; frame <= end; ++frame) {
      int& mine = table.x[static_cast<std::size_t>(a)][static_cast<std::size_t>(frame)];
      if (remove) {
        mine = 0;
      } else {
        std::swap(mine, table.x[static_cast<std::size_t>(b)][static_cast<std::size_t>(frame)]);
      }
    }
  }
  EXPECT_GT(recording.edits.size(), 100u);
  EXPECT_EQ(image(edited(recording)), table.image());
  recording.head = undone(recording.edits, recording.head, 1000);
  EXPECT_EQ(image(edited(recording)), before);
}

/// A racket at x = the frame that may as well be at x = −frame from frame 4 on.
Recording racket(int frames) {
  RecordingHeader header;
  header.rate_hz = 100;
  header.bodies = {{.id = BodyId{3}, .label = "my racket", .skeleton = {}, .parent = {}, .offset = {}, .end = {}, .markers = {}}};
  Recording recording(header);
  for (int frame = 0; frame < frames; ++frame) {
    Instant instant;
    instant.index = 10 + frame;
    instant.time = timestamp_from_seconds(0.01 * frame);
    BodyPose& pose = instant.bodies.emplace_back();
    pose.body = BodyId{3};
    pose.world_from_body.translation.x() = frame;
    if (frame >= 4) pose.other = {{Matrix<3>::Identity(), {-static_cast<double>(frame), 0, 0}}, 0.25};
    recording.add(instant);
  }
  return recording;
}

TEST(Edit, TurnTakesTheOtherPoseOfABody) {
  Recording recording = racket(8);
  const Operation operation = decide_turn(parse_request("turn \"my racket\" 12:15"), recording);
  Edit done = edit_of(operation);
  EXPECT_EQ(operation_of(done), operation);
  done.id = 1;
  recording.edits = {done};
  recording.head = 1;
  const Recording turned = edited(recording);
  for (int frame = 0; frame < 8; ++frame) {
    const BodyPose pose = turned.bodies().at(0).pose(static_cast<std::size_t>(frame));
    const bool exchanged = frame == 4 || frame == 5;
    EXPECT_EQ(pose.world_from_body.translation.x(), exchanged ? -frame : frame) << frame;
    ASSERT_EQ(pose.other.has_value(), frame >= 4) << frame;
    if (pose.other) {
      EXPECT_EQ(pose.other->probability, exchanged ? 0.75 : 0.25) << frame;
    }
  }
  recording.head.reset();
  EXPECT_EQ(edited(recording).bodies().at(0).pose(4).world_from_body.translation.x(), 4);

  const auto refused = [&](const std::string& text) {
    try {
      decide_turn(parse_request(text), recording);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused("turn bat"), "turn: there is no body called \"bat\"");
  EXPECT_EQ(refused("turn \"my racket\" 10:13"), "turn: \"my racket\" has no other pose in question in these frames");
  EXPECT_NE(refused("turn"), "");
  EXPECT_NE(refused("turn \"my racket\" 12:15 z"), "");
}

}  // namespace
}  // namespace marey::edit

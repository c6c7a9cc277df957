#include "marey/format/match/ground_match.h"

#include <algorithm>
#include <filesystem>
#include <functional>
#include <map>
#include <random>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/ground_transform.h"
#include "marey/files/text_safety.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::format::match {
namespace {

using test::read_file;
using test::TemporaryFolder;
using test::write_file;

Sample sample_at(int id, double x, double y) {
  Sample sample;
  sample.track = TrackId{id};
  sample.position = {x, y, 0};
  return sample;
}

/// Two teams of three with numbered shirts and a referee, in two halves; not every person is always there.
GroundMatch made_up(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (static_cast<double>(random()) / 4294967296.0); };
  GroundMatch match;
  match.pitch = {100, 64};
  match.periods = {{1, 3, 30}, {2, 90, 99}};
  for (const GroundPeriod& period : match.periods) {
    for (std::int32_t frame = period.first_frame; frame <= period.last_frame; ++frame) {
      Instant instant;
      instant.index = frame;
      instant.time = timestamp_from_seconds(frame / 25.0);
      for (int id = 1; id <= 7; ++id) {
        if (id > 1 && random() % 5 == 0) continue;
        const double x = uniform(-1, 101), y = uniform(-1, 65);
        instant.samples.push_back(sample_at(id, x, y));
      }
      match.recording.add(instant);
    }
  }
  for (int id = 1; id <= 7; ++id) {
    match.recording.set_name({TrackId{id}, id == 7 ? "" : std::to_string(id + 10),
                              id == 7   ? "referee"
                              : id <= 3 ? "red"
                                        : "green"});
  }
  return match;
}

template <typename Visit>
void for_each_sample(const GroundMatch& match, Visit&& visit) {
  for (const TrackColumns& track : match.recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const Recording::TimeStep& time_step = match.recording.instants()[static_cast<std::size_t>(track.at()[row])];
      visit(track.name, static_cast<std::int32_t>(time_step.index), seconds(time_step.time), track.location(row));
    }
  }
}

using Key = std::tuple<std::int32_t, std::string, std::string>;  // frame, team, label

std::map<Key, Vector<2>> positions_of(const GroundMatch& match) {
  std::map<Key, Vector<2>> locations;
  for_each_sample(match, [&](const TrackName& person, std::int32_t frame, double time, const Vector<2>& location) {
    EXPECT_NEAR(time, frame / match.recording.header.rate_hz, 1e-4);
    locations[{frame, person.team, person.label}] = location;
  });
  return locations;
}

/// The same people in the same frames, to 1 cm.
void expect_same(const std::map<Key, Vector<2>>& found, const std::map<Key, Vector<2>>& required, std::string_view what) {
  EXPECT_EQ(found.size(), required.size()) << what;
  for (const auto& [key, location] : required) {
    const auto theirs = found.find(key);
    ASSERT_NE(theirs, found.end()) << what << ": " << std::get<2>(key) << " of " << std::get<1>(key) << " in frame "
                                   << std::get<0>(key);
    EXPECT_LT((theirs->second - location).cwiseAbs().maxCoeff(), 0.01) << what;
  }
}

const Format& of_ground(const char* name) {
  return *format_named(name, Content::ground);
}

struct Case {
  const char* format;
  const char* name;
  bool referee, teams, halves;  ///< what it can hold
};

const std::vector<Case> kWritten = {
    {"tracab", "m.dat", false, true, true}, {"metrica", "m_home.csv", false, true, true}, {"epts", "m.xml", false, true, true}};

/// Without the referee, which only some formats contain.
std::map<Key, Vector<2>> players_of(const GroundMatch& match) {
  auto locations = positions_of(match);
  std::erase_if(locations,
                [](const auto& entry) { return std::get<1>(entry.first) == "referee" || std::get<1>(entry.first).empty(); });
  return locations;
}

TEST(GroundExchange, MatchesComeBackFromEveryFormat) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const GroundMatch match = made_up(seed);
    for (const Case& one : kWritten) {
      const TemporaryFolder folder;
      const std::string what = fmt::format("{}, seed {}", one.format, seed);
      write_whole(folder / one.name, of_ground(one.format), match);
      ASSERT_EQ(format_of_content(folder / one.name)->name, one.format) << what;
      const GroundMatch back = read_match(folder / one.name, {{}, match.pitch, 25});
      expect_same(players_of(back), players_of(match), what);
      EXPECT_EQ(back.home, "red") << what;
      EXPECT_EQ(back.away, "green") << what;
      EXPECT_DOUBLE_EQ(back.recording.header.rate_hz, 25) << what;
      EXPECT_DOUBLE_EQ(back.pitch.length, 100) << what;
      ASSERT_EQ(back.periods.size(), 2U) << what;
      EXPECT_EQ(back.periods[1].first_frame, 90) << what;
      EXPECT_EQ(back.periods[1].last_frame, 99) << what;
    }
  }
}

TEST(GroundExchange, SoccerNetAndMotKeepIds) {
  const TemporaryFolder folder;
  const GroundMatch match = made_up(3);
  const auto by_id = [](const GroundMatch& one) {
    std::map<std::pair<std::int32_t, int>, Vector<2>> locations;
    for_each_sample(one, [&](const TrackName& person, std::int32_t frame, double, const Vector<2>& location) {
      locations[{frame, number(person.id)}] = location;
    });
    return locations;
  };
  for (const auto& [name, format] :
       {std::pair("m.json", "soccernet"), std::pair("Labels-GameState.json", "soccernet"), std::pair("m.txt", "mot")}) {
    write_whole(folder / name, of_ground(format), match);
    ASSERT_EQ(format_of_content(folder / name)->name, format) << name;
    const GroundMatch back = read_match(folder / name, {{}, match.pitch, 25});
    const auto found = by_id(back), required = by_id(match);
    ASSERT_EQ(found.size(), required.size()) << name;
    for (const auto& [key, location] : required) EXPECT_LT((found.at(key) - location).norm(), 0.002) << name;
  }
}

TEST(GroundExchange, ChainedConversionsKeepContent) {
  const TemporaryFolder folder;
  const GroundMatch match = made_up(11);
  write_whole(folder / "a.dat", of_ground("tracab"), match);
  const GroundMatch first = read_match(folder / "a.dat");
  write_whole(folder / "b.xml", of_ground("epts"), first);
  write_whole(folder / "c_home.csv", of_ground("metrica"), read_match(folder / "b.xml"));
  const GroundMatch last = read_match(folder / "c_away.csv", {{}, match.pitch, 25});
  expect_same(players_of(last), players_of(first), "TRACAB, EPTS, Metrica");
}

TEST(GroundExchange, CornersAreWhereEachFormatHasThem) {
  const TemporaryFolder folder;
  GroundMatch match;
  Instant instant;
  instant.named = {{TrackId{1}, "1", "red"}, {TrackId{2}, "2", "green"}};
  instant.samples = {sample_at(1, 0, 0), sample_at(2, 105, 68)};
  match.recording.add(instant);
  write_whole(folder / "m.dat", of_ground("tracab"), match);
  EXPECT_EQ(read_file(folder / "m.dat"), "0:1,1,1,-5250,-3400,0.00;0,2,2,5250,3400,0.00;:0,0,0,0.00,H,Dead;:\n");
  write_whole(folder / "m_home.csv", of_ground("metrica"), match);
  EXPECT_EQ(read_file(folder / "m_home.csv"),
            ",,,red,,,\n,,,1,,,\nPeriod,Frame,Time [s],Player1,,Ball,\n1,1,0.04000,0.00000,1.00000,NaN,NaN\n");
  write_whole(folder / "e.xml", of_ground("epts"), match);
  EXPECT_EQ(read_file(folder / "e.txt"), "0:0.00000,1.00000;1.00000,0.00000:NaN,NaN\n");
  write_whole(folder / "m.json", of_ground("soccernet"), match);
  EXPECT_NE(read_file(folder / "m.json").find("\"x_bottom_middle\":-52.500,\"y_bottom_middle\":34.000"), std::string::npos);
  const Recording rotated = to_corner(match.recording, match.pitch, {.y_down = true, .centred = false});
  EXPECT_EQ(rotated.tracks()[0].location(0).y(), 68);
  EXPECT_EQ(match.recording.tracks()[0].location(0).y(), 0) << "a change of frame makes a new recording";
  const Recording centred = from_corner(rotated, match.pitch, {.y_down = true, .centred = true});
  EXPECT_EQ(centred.tracks()[0].location(0), Vector<2>(-52.5, -34));
  EXPECT_TRUE(y_grows_down(centred.header)) << "the frame that it came into";
  EXPECT_FALSE(y_grows_down(rotated.header)) << "the corner is below";
  EXPECT_FALSE(y_grows_down(to_corner(centred, match.pitch, {.y_down = true, .centred = true}).header));
}

TEST(GroundExchange, PeopleWithoutTeamsAreAtHomeAndThatIsSaid) {
  const TemporaryFolder folder;
  GroundMatch match = made_up(2);
  for (int id = 1; id <= 7; ++id) match.recording.set_name({TrackId{id}, "", ""});
  const auto warnings = write_whole(folder / "m_home.csv", of_ground("metrica"), match);
  ASSERT_EQ(warnings.size(), 1U);
  const GroundMatch back = read_match(folder / "m_home.csv", {{}, match.pitch, 25});
  EXPECT_EQ(back.recording.samples(), match.recording.samples());
  match.home = "white";
  EXPECT_THROW(write_whole(folder / "m.dat", of_ground("tracab"), match), Error);
}

TEST(GroundExchange, TheBallGoesWhereAFormatHasAPlaceForIt) {
  const TemporaryFolder folder;
  GroundMatch match = made_up(3);
  TrackColumns ball({TrackId{99}, std::string(kBallLabel), {}, {}, TrackKind::ball}, 3);
  for (std::size_t i = 0; i < match.recording.instants().size(); i += 2) {
    Sample sample;
    sample.track = ball.id();
    const auto step = static_cast<double>(i);
    sample.position = {10 + 0.1 * step, 50 - 0.1 * step, 0.11 + 0.01 * step};
    ball.add(static_cast<std::int32_t>(i), sample);
  }
  match.recording.put(ball);
  struct Holds {
    const char* format;
    const char* name;
    double height;  // m, to which it is read back; a pitch where it is not
    bool read;
  };
  for (const Holds& one : {Holds{"ground", "m.csv", 0.001, true}, Holds{"tracab", "m.dat", 0.006, true},
                           Holds{"metrica", "m_home.csv", 100, true}, Holds{"epts", "m.xml", 100, false}}) {
    for (const std::string& warning : write_whole(folder / one.name, of_ground(one.format), match))
      EXPECT_EQ(warning.find("2 people"), std::string::npos) << "the ball is no person: " << warning;
    const GroundMatch back = read_match(folder / one.name, {{}, match.pitch, 25});
    const auto& tracks = back.recording.tracks();
    const auto found =
        std::find_if(tracks.begin(), tracks.end(), [](const TrackColumns& track) { return track.name.kind == TrackKind::ball; });
    ASSERT_EQ(found != tracks.end(), one.read) << one.format;
    if (!one.read) continue;
    ASSERT_EQ(found->size(), ball.size()) << one.format;
    for (std::size_t row = 0; row < ball.size(); ++row) {
      EXPECT_LT((found->location(row) - ball.location(row)).norm(), 0.01) << one.format;
      EXPECT_NEAR(found->position(row).z(), ball.position(row).z(), one.height) << one.format;
    }
  }
}

TEST(GroundExchange, ReportsUnsupportedContent) {
  const TemporaryFolder folder;
  GroundMatch match = made_up(1);
  match.recording.header.rate_hz = 12.5;
  EXPECT_THROW(write_whole(folder / "m.dat", of_ground("tracab"), match), Error);
  EXPECT_THROW(write_whole(folder / "m.xml", of_ground("epts"), match), Error);
  EXPECT_THROW(write_whole(folder / "m.dat", of_ground("tracab"), {}), Error);
  EXPECT_THROW(write_whole(folder / "m.xml", of_ground("sportec"), match), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << "what failed left something behind";
  EXPECT_NO_THROW(write_whole(folder / "m_home.csv", of_ground("metrica"), match));
  EXPECT_NEAR(read_match(folder / "m_home.csv").recording.header.rate_hz, 12.5, 1e-9);
}

TEST(GroundExchange, OutlierTimeKeepsMetricaRate) {
  const TemporaryFolder folder;
  const GroundMatch match = made_up(2);
  write_whole(folder / "m_home.csv", of_ground("metrica"), match);
  const double rate = read_match(folder / "m_home.csv").recording.header.rate_hz;
  for (const char* name : {"m_home.csv", "m_away.csv"}) {
    std::string text = read_file(folder / name);
    const std::size_t row = text.rfind('\n', text.size() - 2) + 1, time = text.find(',', text.find(',', row) + 1) + 1;
    text.replace(time, text.find(',', time) - time, "9999");
    write_file(folder / name, text);
  }
  EXPECT_EQ(read_match(folder / "m_home.csv").recording.header.rate_hz, rate);
}

/// Ends in a recording or in one Error of one line.
bool survives(const std::function<void()>& read) {
  try {
    read();
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos) << error.what();
    return false;
  }
}

TEST(GroundExchange, TornAndScrambledFilesEndInOneSentence) {
  for (const Case& one : std::vector<Case>{kWritten[0],
                                           kWritten[1],
                                           kWritten[2],
                                           {"soccernet", "m.json", true, true, false},
                                           {"mot", "m.txt", true, false, false}}) {
    const TemporaryFolder folder;
    write_whole(folder / one.name, of_ground(one.format), made_up(4));
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) files.push_back(entry.path().string());
    std::mt19937 random(7);
    for (const std::string& file : files) {
      const std::string whole = read_file(file);
      for (int trial = 0; trial < 40; ++trial) {
        std::string text = whole;
        if (trial % 2 == 0)
          text.resize(random() % whole.size());
        else
          for (int i = 0; i < 5; ++i) text[random() % text.size()] = static_cast<char>(random());
        write_file(file, text);
        survives([&] { read_whole(folder / one.name, of_ground(one.format)); });
      }
      write_file(file, whole);
    }
  }
}

TEST(GroundExchange, BadFilesAreNamed) {
  const TemporaryFolder folder;
  const auto stated = [&](const std::string& name, const std::string& text) -> std::string {
    write_file(folder / name, text);
    try {
      read_match(folder / name);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(stated("alone.dat", "1:1,1,1,0,0,0.00;:0,0,0,0.00,H,Dead;:\n").find("--metadata"), std::string::npos);
  EXPECT_NE(stated("alone_home.csv", ",,,a,,,\n,,,1,,,\nPeriod,Frame,Time [s],Player1,,Ball,\n").find("pairs"), std::string::npos);
  EXPECT_NE(stated("none.txt", "").find("empty"), std::string::npos);
  EXPECT_NE(stated("far.txt", "1,1,-1,-1,-1,-1,1,1e7,0,0\n").find("far.txt:1"), std::string::npos);
  EXPECT_NE(stated("twice.txt", "1,1,-1,-1,-1,-1,1,5,0,0\n1,1,-1,-1,-1,-1,1,6,0,0\n").find("twice"), std::string::npos);
  EXPECT_NE(stated("list.json", "{\"predictions\": {}}").find("list.json"), std::string::npos);
  EXPECT_NE(stated("open.json", "{\"predictions\": [").find("not JSON"), std::string::npos);
  EXPECT_THROW(read_match(folder / "missing.dat"), Error);
  EXPECT_THROW(read_match(folder.path()), Error);
}

TEST(GroundExchange, PeopleAreListedAsTheFileNamesThem) {
  const TemporaryFolder folder;
  write_file(folder / "m.txt", "1,9,-1,-1,-1,-1,1,5,5,0\n1,2,-1,-1,-1,-1,1,6,6,0\n2,4,-1,-1,-1,-1,1,7,7,0\n");
  const GroundMatch match = read_match(folder / "m.txt");
  EXPECT_EQ(match.order, (std::vector<TrackId>{TrackId{9}, TrackId{2}, TrackId{4}}));
  write_whole(folder / "m_home.csv", of_ground("metrica"), match);
  EXPECT_NE(read_file(folder / "m_home.csv").find("Player9,,Player2,,Player4"), std::string::npos);
}

TEST(GroundExchange, PixelsAreRefusedByEveryFormat) {
  const TemporaryFolder folder;
  GroundMatch match = made_up(1);
  match.recording.header.name = "tracks.csv";
  match.recording.header.frame.kind = FrameOfReference::Kind::image;
  for (const char* format : {"ground", "mot", "metrica", "tracab", "epts", "soccernet"}) {
    try {
      write_whole(folder / "m_home.csv", of_ground(format), match);
      ADD_FAILURE() << format;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("tracks.csv"), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find("px"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(to_corner(match.recording, match.pitch, {}), Error);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

/// Of the first person that the file names, at the first instant.
Vector<2> first_position(const GroundMatch& match) {
  InstantRows rows(match.recording);
  const InstantRows::Row row = rows.at(0).front();
  return match.recording.tracks()[row.track].location(row.row);
}

TEST(GroundExchange, AcceptsOriginAsPosition) {
  const TemporaryFolder folder;
  GroundMatch match;
  match.recording.header.rate_hz = 25;
  Instant instant;
  instant.samples = {sample_at(1, -1, -1)};
  match.recording.add(instant);
  write_whole(folder / "m.txt", of_ground("mot"), match);
  EXPECT_EQ(first_position(read_match(folder / "m.txt")), Vector<2>(-1, -1));
  for (const char* nowhere : {"1,1,-1,-1,-1,-1,1,-1,-1,-1\n", "1,1,-1,-1,-1,-1,1,-1,-1\n"})
    EXPECT_THROW(parse_mot_world(nowhere, "m.txt", 25), Error) << nowhere;
}

TEST(GroundExchange, RatesThatCouldNotBeReadAreNotWritten) {
  const TemporaryFolder folder;
  GroundMatch match = made_up(1);
  for (const double rate_hz : {1e-9, 1.25e8}) {
    match.recording.header.rate_hz = rate_hz;
    for (const char* format : {"metrica", "tracab", "epts"})
      EXPECT_THROW(write_whole(folder / "m_home.csv", of_ground(format), match), Error) << format << " " << rate_hz;
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GroundExchange, FilesOfVendors) {
  const std::string folder = test::data("football_files/");
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not here";
  struct Expected {
    const char* name;
    const char* format;
    std::int64_t samples;
    std::size_t people, periods;
    Vector<2> first;
  };
  // By hand: of TRACAB the first target, -4.72 m of its second shirt; of the others the first line's first person.
  for (const Expected& one : {Expected{"tracab_raw.dat", "tracab", 505, 0, 2, {52.56, 24.87}},
                              Expected{"epts_metrica_tracking.txt", "epts", 1900, 22, 2, {105 * 0.30602, 68 * (1 - 0.97029)}},
                              Expected{"metrica_away.csv", "metrica", 132, 28, 2, {105 * 0.00082, 68 * (1 - 0.48238)}},
                              Expected{"sportec_positional.xml", "sportec", 288, 3, 2, {0, 0}},
                              Expected{"statsperform_tracking_ma25.txt", "statsperform", 2025, 0, 2, {52.803, 68 - 23.617}}}) {
    ASSERT_EQ(format_of_content(folder + one.name)->name, one.format) << one.name;
    GroundMatch match = read_match(folder + one.name);
    match.recording.erase_tracks_if([](const TrackColumns& track) { return track.name.kind == TrackKind::ball; });
    EXPECT_EQ(match.recording.samples(), one.samples) << one.name;
    if (one.people > 0) {
      EXPECT_EQ(match.recording.tracks().size(), one.people) << one.name;
    }
    EXPECT_EQ(match.periods.size(), one.periods) << one.name;
    if (one.first != Vector<2>::Zero()) {
      EXPECT_LT((first_position(match) - one.first).norm(), 1e-6) << one.name;
    }
  }
  const GroundMatch pets = read_match(test::data("pets2009/gt_001_300.txt"));
  EXPECT_EQ(pets.order.front(), TrackId{9}) << "people are listed as the file names them";
  EXPECT_LT((pets.recording.find(TrackId{9})->location(0) - Vector<2>(-4.1554, -7.3591)).norm(), 1e-9);
}

TEST(GroundExchange, DeepFilesAreRefusedAndNoMessageShowsALibrarysInternals) {
  const auto stated = [](auto parse) -> std::string {
    try {
      parse();
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  std::string lists = "{\"predictions\": ", elements;
  for (int i = 0; i < 200'000; ++i) lists += '[', elements += "<a>";
  EXPECT_NE(stated([&] { parse_soccernet(lists, "m.json", {}); }).find("m.json:1: is nested more than"), std::string::npos);
  EXPECT_NE(stated([&] { parse_sportec(elements, "m.xml", {}, {}); }).find("m.xml:1: is nested more than"), std::string::npos);
  EXPECT_NE(stated([&] { parse_epts("1:1:1,1,1:\n", "m.txt", elements, "m.xml"); }).find("m.xml:1: is nested more than"),
            std::string::npos);
  for (const char* text : {"{\"predictions\": [", "\xff\xfe", "[1, 2}", "{\"predictions\": [1e999999]}"}) {
    const std::string message = stated([&] { parse_soccernet(text, "m.json", {}); });
    EXPECT_TRUE(message.starts_with("m.json")) << message;
    EXPECT_EQ(message.find("exception"), std::string::npos) << message;
    EXPECT_EQ(message.find("syntax error"), std::string::npos) << message;
  }
}

TEST(GroundExchange, TheRateIsTheMedianStep) {
  const TemporaryFolder folder;
  std::string text = "frame,time,id,x,y\n";
  for (int i = 0; i < 100; ++i) text += fmt::format("{},{:.4f},1,2,3\n", i, i == 99 ? -5000 : i / 25.0);
  write_file(folder / "m.csv", text);
  EXPECT_DOUBLE_EQ(read_match(folder / "m.csv").recording.header.rate_hz, 25);
  std::string far = "1,1,-1,-1,-1,-1,1,5,0,0\n2,1,-1,-1,-1,-1,1,5,0,0\n999999999,1,-1,-1,-1,-1,1,5,0,0\n";
  try {
    parse_mot_world(far, "m.txt", 25);
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string_view(error.what()).find("of which 3 are there; a number must be wrong"), std::string_view::npos)
        << error.what();
  }
}

TEST(GroundExchange, ForeignBytesInNamesMakeFilesThatCanBeRead) {
  GroundMatch match = made_up(4);
  match.recording.set_name({TrackId{1}, "a\x01\x1B<b>&\"\xFF", "red"});
  match.recording.set_name({TrackId{2}, "=1+1", "red"});
  for (const Case& one : kWritten) {
    const TemporaryFolder folder;
    write_whole(folder / one.name, of_ground(one.format), match);
    EXPECT_NO_THROW(read_whole(folder / one.name, of_ground(one.format))) << one.name;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const std::string text = read_file(entry.path().string());
      EXPECT_EQ(plain_text(text).find("\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD"), std::string::npos);
      for (const char c : text)
        EXPECT_TRUE(static_cast<unsigned char>(c) >= ' ' || c == '\n' || c == '\r' || c == '\t') << entry.path();
      EXPECT_EQ(text.find("&#"), std::string::npos) << entry.path() << ": a control character by number";
    }
  }
}

}  // namespace
}  // namespace marey::format::match

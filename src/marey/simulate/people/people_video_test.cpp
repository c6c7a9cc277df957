#include "marey/simulate/people/people_video.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::simulate::people {
namespace {

PeopleVideoOptions small(double height = 40) {
  PeopleVideoOptions options;
  options.size = {320, 240};
  options.height_px = height;
  options.ground = Image(cv::Mat(240, 320, CV_8UC1, cv::Scalar(110)));
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PeopleVideo, TheSameSeedGivesTheSameFilm) {
  for (const NamedPeopleSituation& named : people_situations()) {
    const PeopleVideo a(named.situation, 3, small()), b(named.situation, 3, small()), c(named.situation, 4, small());
    const RenderedFrame one = a.render(30), two = b.render(30), other = c.render(30);
    EXPECT_TRUE(same(one.image.luma(), two.image.luma())) << named.name;
    EXPECT_TRUE(same(one.image.cb(), two.image.cb())) << named.name;
    EXPECT_FALSE(same(one.image.luma(), other.image.luma())) << named.name;
  }
}

TEST(PeopleVideo, SilhouettesAreWhereThePictureDiffersFromTheGround) {
  PeopleVideoOptions options = small();
  options.noise = 0;
  options.shadows = false;
  for (const NamedPeopleSituation& named : people_situations()) {
    if (named.situation == PeopleSituation::post) continue;  // posts differ from the ground as well
    const PeopleVideo video(named.situation, 5, options);
    const RenderedFrame frame = video.render(40);
    cv::Mat anyone = cv::Mat::zeros(options.size, CV_8UC1);
    for (const TrueFigure& person : frame.people) anyone |= person.visible.pixel_mask(options.size);
    const int ground = video.render(0).image.luma().at<std::uint8_t>(0, 0);
    int differs = 0, wrong = 0;
    for (int y = 0; y < anyone.rows; ++y) {
      for (int x = 0; x < anyone.cols; ++x) {
        const bool other = frame.image.luma().at<std::uint8_t>(y, x) != ground;
        differs += other ? 1 : 0;
        wrong += other != (anyone.at<std::uint8_t>(y, x) != 0) ? 1 : 0;
      }
    }
    ASSERT_GT(differs, 100) << named.name;
    // Pixels at the edge that are covered by less than half differ as well, and inside a colour may be the ground's.
    EXPECT_LT(wrong, 0.45 * differs) << named.name;
  }
}

TEST(PeopleVideo, TheVisibleIsPartOfTheWholeAndPeopleShareNoPoint) {
  PeopleVideoOptions options = small(60);
  options.people = 8;
  const PeopleVideo video(PeopleSituation::crowd, 2, options);
  for (int i = 0; i < video.frames(); i += 20) {
    const RenderedFrame frame = video.render(i);
    cv::Mat owners = cv::Mat::zeros(options.size * options.samples, CV_8UC1);
    for (const TrueFigure& person : frame.people) {
      EXPECT_GE(person.visible_fraction, 0);
      EXPECT_LE(person.visible_fraction, 1);
      EXPECT_LE(person.visible.area(), person.whole.area());
      if (person.visible.empty()) continue;
      owners(person.visible.lattice) += (person.visible.mask != 0) / 255;
    }
    double maximum = 0;
    cv::minMaxLoc(owners, nullptr, &maximum);
    EXPECT_LE(maximum, 1) << "frame " << i;
  }
}

TEST(PeopleVideo, SeparatedPeopleAreNeverOccluded) {
  for (const auto situation : {PeopleSituation::apart, PeopleSituation::abrupt}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const PeopleVideo video(situation, seed, small(25));
      for (int i = 0; i < video.frames(); i += 8) {
        const RenderedFrame frame = video.render(i);
        EXPECT_EQ(frame.people.size(), video.figures().size()) << "seed " << seed;
        for (const TrueFigure& person : frame.people) EXPECT_GT(person.visible_fraction, 0.98) << "seed " << seed << " frame " << i;
      }
    }
  }
}

TEST(PeopleVideo, HeightsAreAsAskedInTheMiddle) {
  for (const double height : {25.0, 60.0, 150.0}) {
    PeopleVideoOptions options;
    options.height_px = height;
    options.people = 1;
    options.ground = Image(cv::Mat(576, 768, CV_8UC1, cv::Scalar(110)));
    const PeopleVideo video(PeopleSituation::apart, 1, options);
    const TrueFigure person = video.render(50).people.front();
    EXPECT_NEAR(person.whole.box().height, height, 0.3 * height);
    EXPECT_NEAR(person.foot.y(), person.whole.box().bottom(), 0.15 * height);
  }
}

TEST(PeopleVideo, CrossingHidesThePartOfOneForAboutTwentyFrames) {
  double frames = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const PeopleVideo video(PeopleSituation::crossing, seed, small());
    double minimum = 1;
    for (int i = 0; i < video.frames(); ++i) {
      const RenderedFrame frame = video.render(i);
      for (const TrueFigure& person : frame.people) {
        if (person.id != 1) continue;
        minimum = std::min(minimum, person.visible_fraction);
        frames += person.visible_fraction < 0.97 ? 1 : 0;
      }
    }
    EXPECT_LT(minimum, 0.9) << "seed " << seed;
    EXPECT_GT(minimum, 0.1) << "seed " << seed;
  }
  EXPECT_NEAR(frames / 20, 18, 8);
}

TEST(PeopleVideo, ABoardHidesEachForAsLongAsAskedAndNeverAtTheEnds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PeopleVideoOptions options = small(25);
    const PeopleVideo video(PeopleSituation::post, seed, options);
    std::map<int, int> hidden;
    for (int i = 0; i < video.frames(); ++i) {
      const RenderedFrame frame = video.render(i);
      for (const TrueFigure& person : frame.people) {
        hidden[person.id] += person.visible_fraction < 0.01 ? 1 : 0;
        if (i < 25 || i >= video.frames() - 25) {
          EXPECT_GT(person.visible_fraction, 0.5) << "seed " << seed << " frame " << i;
        }
      }
    }
    for (const auto& [id, frames] : hidden) {
      EXPECT_GE(frames, 5) << "seed " << seed;
      EXPECT_LE(frames, 65) << "seed " << seed;
    }
  }
}

TEST(PeopleVideo, TwoWhoMeetBehindABoardAreHiddenAtOnceForAsLongAsAsked) {
  int all = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    PeopleVideoOptions options = small(25);
    options.frames = 90;
    options.people = 3;
    options.hidden_s = 0.5;
    options.min_hidden_s = 0.5;
    options.in_pairs = true;
    const PeopleVideo video(PeopleSituation::post, seed, options);
    ASSERT_EQ(video.figures().size(), 2U * 3U);
    std::map<int, int> hidden;
    std::map<int, int> together;  // by the first of a pair, whose ids follow each other
    std::map<int, double> begins, ends;
    for (int i = 0; i < video.frames(); ++i) {
      std::map<int, bool> now;
      for (const TrueFigure& person : video.render(i).people) {
        now[person.id] = person.visible_fraction < 0.01;
        hidden[person.id] += now[person.id] ? 1 : 0;
        if (i == 0) begins[person.id] = person.foot.x();
        ends[person.id] = person.foot.x();
      }
      for (int id = 1; id < 6; id += 2) together[id] += now[id] && now[id + 1] ? 1 : 0;
    }
    for (int id = 1; id < 6; id += 2) {
      // Of 12.5 frames; a person's own width varies with the stride.
      for (const int one : {id, id + 1}) EXPECT_NEAR(hidden[one], 12.5, 8) << "seed " << seed << " person " << one;
      all += hidden[id] + hidden[id + 1];
      EXPECT_GE(together[id], 3) << "seed " << seed;
      EXPECT_LT((begins[id] - begins[id + 1]) * (ends[id] - ends[id + 1]), 0) << "seed " << seed;
    }
  }
  EXPECT_NEAR(all / 30.0, 12.5, 4);
}

TEST(PeopleVideo, PersonCrossesBorder) {
  const PeopleVideo video(PeopleSituation::border, 1, small(25));
  int cut = 0;
  for (int i = 0; i < video.frames(); ++i) {
    for (const TrueFigure& person : video.render(i).people)
      cut += person.visible_fraction > 0.1 && person.visible_fraction < 0.9 ? 1 : 0;
  }
  EXPECT_GT(cut, 20);
}

TEST(PeopleVideo, LightChangesAsAsked) {
  PeopleVideoOptions options = small();
  options.noise = 0;
  options.light = LightChange::sudden;
  const PeopleVideo video(PeopleSituation::apart, 1, options);
  int jumps = 0;
  for (int i = 1; i < video.frames(); ++i) {
    const double before = cv::mean(video.render(i - 1).image.luma())[0];
    jumps += std::abs(cv::mean(video.render(i).image.luma())[0] - before) > 15 ? 1 : 0;
  }
  EXPECT_EQ(jumps, 2);
}

TEST(PeopleVideo, EarlierVideoHasSameSceneWithOtherPeople) {
  PeopleVideoOptions options = small(25);
  options.people = 0;
  options.noise = 0;
  const PeopleVideo video(PeopleSituation::apart, 1, options);
  const cv::Mat empty = video.render(0).image.luma();
  for (int i = 0; i < PeopleVideo::kEarlier; ++i) {
    const int differ = cv::countNonZero(video.render_earlier(i).luma() != empty);
    EXPECT_GT(differ, 100) << i;
    EXPECT_LT(differ, empty.rows * empty.cols / 8) << i;
  }
}

TEST(PeopleVideo, IsASource) {
  PeopleVideoOptions options = small();
  options.frames = 5;
  const auto source = make_source(std::make_shared<const PeopleVideo>(PeopleSituation::crowd, 1, options));
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->index, frames);
    EXPECT_NEAR(seconds(frame->time), frames / 25.0, 1e-9);
    EXPECT_EQ(frame->image.size(), options.size);
    ++frames;
  }
  EXPECT_EQ(frames, 5);
  EXPECT_EQ(source->info().size, options.size);
}

TEST(PeopleVideo, OptionsOutOfTheirDomainAreRefused) {
  PeopleVideoOptions options = small();
  options.rate_hz = 0;
  EXPECT_THROW(PeopleVideo(PeopleSituation::crowd, 1, options), Error);
  options = small();
  options.height_px = 4000;
  EXPECT_THROW(PeopleVideo(PeopleSituation::crowd, 1, options), Error);
  options = small();
  options.people = 0;
  EXPECT_TRUE(PeopleVideo(PeopleSituation::crowd, 1, options).render(10).people.empty());
  options = small();
  options.min_hidden_s = 3;  // above the longest
  EXPECT_THROW(PeopleVideo(PeopleSituation::post, 1, options), Error);
  options.min_hidden_s = 0;
  EXPECT_THROW(PeopleVideo(PeopleSituation::post, 1, options), Error);
}

}  // namespace
}  // namespace marey::simulate::people

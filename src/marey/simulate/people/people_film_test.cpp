#include "marey/simulate/people/people_film.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::simulate::people {
namespace {

PeopleFilmOptions small(double height = 40) {
  PeopleFilmOptions options;
  options.size = {320, 240};
  options.height_px = height;
  options.ground = Picture(cv::Mat(240, 320, CV_8UC1, cv::Scalar(110)));
  return options;
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(PeopleFilm, TheSameSeedGivesTheSameFilm) {
  for (const NamedPeopleSituation& named : people_situations()) {
    const PeopleFilm a(named.situation, 3, small()), b(named.situation, 3, small()), c(named.situation, 4, small());
    const RenderedFrame one = a.render(30), two = b.render(30), other = c.render(30);
    EXPECT_TRUE(same(one.picture.luma(), two.picture.luma())) << named.name;
    EXPECT_TRUE(same(one.picture.cb(), two.picture.cb())) << named.name;
    EXPECT_FALSE(same(one.picture.luma(), other.picture.luma())) << named.name;
  }
}

TEST(PeopleFilm, SilhouettesAreWhereThePictureDiffersFromTheGround) {
  PeopleFilmOptions options = small();
  options.noise = 0;
  options.shadows = false;
  for (const NamedPeopleSituation& named : people_situations()) {
    if (named.situation == PeopleSituation::post) continue;  // posts differ from the ground as well
    const PeopleFilm film(named.situation, 5, options);
    const RenderedFrame frame = film.render(40);
    cv::Mat anyone = cv::Mat::zeros(options.size, CV_8UC1);
    for (const TrueFigure& person : frame.people) anyone |= person.visible.pixel_mask(options.size);
    const int ground = film.render(0).picture.luma().at<std::uint8_t>(0, 0);
    int differs = 0, wrong = 0;
    for (int y = 0; y < anyone.rows; ++y) {
      for (int x = 0; x < anyone.cols; ++x) {
        const bool other = frame.picture.luma().at<std::uint8_t>(y, x) != ground;
        differs += other ? 1 : 0;
        wrong += other != (anyone.at<std::uint8_t>(y, x) != 0) ? 1 : 0;
      }
    }
    ASSERT_GT(differs, 100) << named.name;
    // Pixels at the edge that are covered by less than half differ as well, and inside a colour may be the ground's.
    EXPECT_LT(wrong, 0.45 * differs) << named.name;
  }
}

TEST(PeopleFilm, TheVisibleIsPartOfTheWholeAndPeopleShareNoPoint) {
  PeopleFilmOptions options = small(60);
  options.people = 8;
  const PeopleFilm film(PeopleSituation::crowd, 2, options);
  for (int i = 0; i < film.frames(); i += 20) {
    const RenderedFrame frame = film.render(i);
    cv::Mat owners = cv::Mat::zeros(options.size * options.samples, CV_8UC1);
    for (const TrueFigure& person : frame.people) {
      EXPECT_GE(person.visible_share, 0);
      EXPECT_LE(person.visible_share, 1);
      EXPECT_LE(person.visible.area(), person.whole.area());
      if (person.visible.empty()) continue;
      owners(person.visible.lattice) += (person.visible.mask != 0) / 255;
    }
    double most = 0;
    cv::minMaxLoc(owners, nullptr, &most);
    EXPECT_LE(most, 1) << "frame " << i;
  }
}

TEST(PeopleFilm, WhoKeepsApartIsNeverHidden) {
  for (const auto situation : {PeopleSituation::apart, PeopleSituation::abrupt}) {
    for (std::uint64_t seed = 0; seed < 6; ++seed) {
      const PeopleFilm film(situation, seed, small(25));
      for (int i = 0; i < film.frames(); i += 8) {
        const RenderedFrame frame = film.render(i);
        EXPECT_EQ(frame.people.size(), film.figures().size()) << "seed " << seed;
        for (const TrueFigure& person : frame.people) EXPECT_GT(person.visible_share, 0.98) << "seed " << seed << " frame " << i;
      }
    }
  }
}

TEST(PeopleFilm, HeightsAreAsAskedInTheMiddle) {
  for (const double height : {25.0, 60.0, 150.0}) {
    PeopleFilmOptions options;
    options.height_px = height;
    options.people = 1;
    options.ground = Picture(cv::Mat(576, 768, CV_8UC1, cv::Scalar(110)));
    const PeopleFilm film(PeopleSituation::apart, 1, options);
    const TrueFigure person = film.render(50).people.front();
    EXPECT_NEAR(person.whole.box().height, height, 0.3 * height);
    EXPECT_NEAR(person.foot.y(), person.whole.box().bottom(), 0.15 * height);
  }
}

TEST(PeopleFilm, CrossingHidesThePartOfOneForAboutTwentyFrames) {
  double frames = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const PeopleFilm film(PeopleSituation::crossing, seed, small());
    double least = 1;
    for (int i = 0; i < film.frames(); ++i) {
      const RenderedFrame frame = film.render(i);
      for (const TrueFigure& person : frame.people) {
        if (person.id != 1) continue;
        least = std::min(least, person.visible_share);
        frames += person.visible_share < 0.97 ? 1 : 0;
      }
    }
    EXPECT_LT(least, 0.9) << "seed " << seed;
    EXPECT_GT(least, 0.1) << "seed " << seed;
  }
  EXPECT_NEAR(frames / 20, 18, 8);
}

TEST(PeopleFilm, ABoardHidesEachForAsLongAsAskedAndNeverAtTheEnds) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PeopleFilmOptions options = small(25);
    const PeopleFilm film(PeopleSituation::post, seed, options);
    std::map<int, int> hidden;
    for (int i = 0; i < film.frames(); ++i) {
      const RenderedFrame frame = film.render(i);
      for (const TrueFigure& person : frame.people) {
        hidden[person.id] += person.visible_share < 0.01 ? 1 : 0;
        if (i < 25 || i >= film.frames() - 25) {
          EXPECT_GT(person.visible_share, 0.5) << "seed " << seed << " frame " << i;
        }
      }
    }
    for (const auto& [id, frames] : hidden) {
      EXPECT_GE(frames, 5) << "seed " << seed;
      EXPECT_LE(frames, 65) << "seed " << seed;
    }
  }
}

TEST(PeopleFilm, SomebodyCrossesTheBorder) {
  const PeopleFilm film(PeopleSituation::border, 1, small(25));
  int cut = 0;
  for (int i = 0; i < film.frames(); ++i) {
    for (const TrueFigure& person : film.render(i).people) cut += person.visible_share > 0.1 && person.visible_share < 0.9 ? 1 : 0;
  }
  EXPECT_GT(cut, 20);
}

TEST(PeopleFilm, LightChangesAsAsked) {
  PeopleFilmOptions options = small();
  options.noise = 0;
  options.light = LightChange::sudden;
  const PeopleFilm film(PeopleSituation::apart, 1, options);
  int jumps = 0;
  for (int i = 1; i < film.frames(); ++i) {
    const double before = cv::mean(film.render(i - 1).picture.luma())[0];
    jumps += std::abs(cv::mean(film.render(i).picture.luma())[0] - before) > 15 ? 1 : 0;
  }
  EXPECT_EQ(jumps, 2);
}

TEST(PeopleFilm, WhatWasSeenEarlierIsTheSameSceneWithOthersInIt) {
  PeopleFilmOptions options = small(25);
  options.people = 0;
  options.noise = 0;
  const PeopleFilm film(PeopleSituation::apart, 1, options);
  const cv::Mat empty = film.render(0).picture.luma();
  for (int i = 0; i < PeopleFilm::kEarlier; ++i) {
    const int differ = cv::countNonZero(film.render_earlier(i).luma() != empty);
    EXPECT_GT(differ, 100) << i;
    EXPECT_LT(differ, empty.rows * empty.cols / 8) << i;
  }
}

TEST(PeopleFilm, IsASource) {
  PeopleFilmOptions options = small();
  options.frames = 5;
  const auto source = make_source(std::make_shared<const PeopleFilm>(PeopleSituation::crowd, 1, options));
  int frames = 0;
  while (const auto frame = source->next()) {
    EXPECT_EQ(frame->index, frames);
    EXPECT_NEAR(seconds(frame->time), frames / 25.0, 1e-9);
    EXPECT_EQ(frame->picture.size(), options.size);
    ++frames;
  }
  EXPECT_EQ(frames, 5);
  EXPECT_EQ(source->info().size, options.size);
}

TEST(PeopleFilm, OptionsOutOfTheirDomainAreRefused) {
  PeopleFilmOptions options = small();
  options.rate_hz = 0;
  EXPECT_THROW(PeopleFilm(PeopleSituation::crowd, 1, options), Error);
  options = small();
  options.height_px = 4000;
  EXPECT_THROW(PeopleFilm(PeopleSituation::crowd, 1, options), Error);
  options = small();
  options.people = 0;
  EXPECT_TRUE(PeopleFilm(PeopleSituation::crowd, 1, options).render(10).people.empty());
}

}  // namespace
}  // namespace marey::simulate::people

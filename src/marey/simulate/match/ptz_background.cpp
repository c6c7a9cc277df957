#include "marey/simulate/match/ptz_background.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/random.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::match {
namespace {

constexpr double kTexel = 0.1;       // m, of the ground
constexpr double kRound = 11;        // m from the lines to the walls
constexpr double kNear = 34;         // m of ground before the near touchline
constexpr double kWallTexel = 0.06;  // m
constexpr double kWallHigh = 30;     // m, sky included
constexpr double kBoardHigh = 1, kStandHigh = 17;
constexpr double kMowing = 5.25;  // m
constexpr int kRayGrid = 8;       // px between rays that are undistorted
constexpr int kSuper = 4;         // places of paint in a pixel, in each direction
constexpr int kFixed = 4;         // bits after the point of a polygon's corners

struct Extent {
  explicit Extent(const geometry::PitchSize& pitch)
      : ground(static_cast<int>((pitch.length + 2 * kRound) / kTexel), static_cast<int>((pitch.width + kRound + kNear) / kTexel)),
        depth(pitch.width + kRound + kNear),
        across(pitch.length + 2 * kRound),
        wall(static_cast<int>((across + 2 * depth) / kWallTexel), static_cast<int>(kWallHigh / kWallTexel)) {}
  cv::Size ground;
  double depth, across;  // m
  cv::Size wall;
};

cv::Vec3b shaded(double blue, double green, double red, double bright) {
  return {cv::saturate_cast<std::uint8_t>(blue * bright), cv::saturate_cast<std::uint8_t>(green * bright),
          cv::saturate_cast<std::uint8_t>(red * bright)};
}

/// Stripes differ as they do on most pitches at 1; beyond, their seams shine as well, as narrow as paint.
double mown_bright(double x, double mowing) {
  constexpr double kSeam = 0.1;  // m
  const double from_seam = std::abs(std::remainder(x, kMowing));
  return mowing > 1 && from_seam < kSeam ? 1 + 0.25 * (mowing - 1) : 1;
}

void draw_grass(cv::Mat ground, const geometry::PitchSize& pitch, double mowing, std::uint64_t seed) {
  cv::parallel_for_(cv::Range(0, ground.rows), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      for (int column = 0; column < ground.cols; ++column) {
        const Vector<2> at((column + 0.5) * kTexel - kRound, (row + 0.5) * kTexel - kNear);
        const double bright = 1 + 0.06 * value_noise(at / 12, seed) + 0.05 * value_noise(at / 3.1, seed + 1) +
                              0.05 * value_noise(at / 0.8, seed + 2) + 0.06 * value_noise(at / 0.25, seed + 3);
        const bool even = static_cast<std::int64_t>(std::floor((at.x() + 100 * kMowing) / kMowing)) % 2 == 0;
        const bool mown = at.x() > -4 && at.x() < pitch.length + 4 && at.y() > -4 && at.y() < pitch.width + 4;
        ground.at<cv::Vec3b>(row, column) =
            mown && even ? shaded(70 + 2 * mowing, 98 + 12 * mowing, 76 + 16 * mowing, bright * mown_bright(at.x(), mowing))
                         : shaded(70, mown ? 98 : 92, 76, mown ? bright * mown_bright(at.x(), mowing) : bright);
      }
    }
  });
}

/// Lights on wet grass: streaks towards the camera, as bright as paint where they are brightest.
void wet_grass(cv::Mat ground, double wet, std::uint64_t seed) {
  constexpr double kStreakAcross = 0.35, kStreakAlong = 7, kPool = 9;  // m
  cv::parallel_for_(cv::Range(0, ground.rows), [&](const cv::Range& rows) {
    for (int row = rows.start; row < rows.end; ++row) {
      for (int column = 0; column < ground.cols; ++column) {
        const Vector<2> at((column + 0.5) * kTexel, (row + 0.5) * kTexel);
        const double streak = value_noise(at.cwiseQuotient(Vector<2>(kStreakAcross, kStreakAlong)), seed + 11);
        const double pool = 0.5 + 0.5 * value_noise(at / kPool, seed + 12);
        const double light = 70 * wet * pool * std::max(0.0, streak);
        for (int i = 0; i < 3; ++i) {
          std::uint8_t& level = ground.at<cv::Vec3b>(row, column)[i];
          level = cv::saturate_cast<std::uint8_t>(level + light);
        }
      }
    }
  });
}

/// Mats beside the lines, with white edges: lines that are parallel to those of the pitch.
void lay_mats(cv::Mat ground, const geometry::PitchSize& pitch) {
  constexpr double kMatFrom = 2.2, kMatWide = 2.5, kMatEdge = 0.15;  // m
  const auto rect = [&](double x, double y, double width, double height) {
    return cv::Rect(cvRound((x + kRound) / kTexel), cvRound((y + kNear) / kTexel), cvRound(width / kTexel),
                    cvRound(height / kTexel)) &
           cv::Rect({}, ground.size());
  };
  const auto lay = [&](double x, double y, double width, double height) {
    ground(rect(x, y, width, height)) = cv::Scalar(205, 212, 206);
    ground(rect(x + kMatEdge, y + kMatEdge, width - 2 * kMatEdge, height - 2 * kMatEdge)) = cv::Scalar(60, 92, 70);
  };
  for (double along = -4; along < pitch.length - 4; along += 28) lay(along, pitch.width + kMatFrom, 24, kMatWide);
  for (double along = 4; along < pitch.width - 12; along += 26) {
    if (std::abs(along + 12 - pitch.width / 2) < 13) continue;
    lay(-kMatFrom - kMatWide, along, kMatWide, 22), lay(pitch.length + kMatFrom, along, kMatWide, 22);
  }
}

/// The lines of field hockey, 91.4 × 55 m, in the middle of this ground.
std::vector<geometry::PitchLine> hockey_lines(const geometry::PitchSize& pitch) {
  constexpr double kHockeyLength = 91.4, kHockeyWidth = 55, kHockeyFromGoal = 22.9, kHockeyCircle = 14.63, kHockeyPost = 1.83,
                   kHockeyStep = 0.5;  // m
  const Vector<2> corner((pitch.length - kHockeyLength) / 2, (pitch.width - kHockeyWidth) / 2);
  std::vector<geometry::PitchLine> lines;
  const auto straight = [&](const Vector<2>& from, const Vector<2>& to) {
    geometry::PitchLine& line = lines.emplace_back();
    const Vector<2> along = (to - from).normalized();
    for (double at = 0; at <= (to - from).norm(); at += kHockeyStep)
      line.points.push_back(corner + from + at * along), line.tangents.push_back(along);
  };
  for (const double y : {0.0, kHockeyWidth}) straight({0, y}, {kHockeyLength, y});
  for (const double x : {0.0, kHockeyFromGoal, kHockeyLength / 2, kHockeyLength - kHockeyFromGoal, kHockeyLength})
    straight({x, 0}, {x, kHockeyWidth});
  for (const double side : {-1.0, 1.0}) {
    const double x = side < 0 ? 0 : kHockeyLength;
    straight({x - side * kHockeyCircle, kHockeyWidth / 2 - kHockeyPost},
             {x - side * kHockeyCircle, kHockeyWidth / 2 + kHockeyPost});
    for (const double post : {-1.0, 1.0}) {
      geometry::PitchLine& arc = lines.emplace_back();
      for (double angle = 0; angle <= M_PI / 2; angle += kHockeyStep / kHockeyCircle) {
        const Vector<2> out(-side * std::cos(angle), post * std::sin(angle));
        arc.points.push_back(corner + Vector<2>(x, kHockeyWidth / 2 + post * kHockeyPost) + kHockeyCircle * out);
        arc.tangents.emplace_back(-out.y(), out.x());
      }
    }
  }
  return lines;
}

/// The lines of a children's pitch across a half of this one.
std::vector<geometry::PitchLine> junior_lines(const geometry::PitchSize& pitch, bool right) {
  const double width = 0.8 * pitch.length / 2, length = 0.82 * pitch.width;
  std::vector<geometry::PitchLine> lines = geometry::pitch_lines({length, width}, 0.5);
  const Vector<2> corner(right ? pitch.length - 0.1 * pitch.length / 2 : 0.9 * pitch.length / 2, 0.09 * pitch.width);
  for (geometry::PitchLine& line : lines) {  // turned by a quarter
    for (Vector<2>& point : line.points) point = corner + Vector<2>(-point.y(), point.x());
    for (Vector<2>& tangent : line.tangents) tangent = Vector<2>(-tangent.y(), tangent.x());
  }
  return lines;
}

/// Straight lines that are of no football pitch: another sport's, a training ground's.
geometry::PitchLine other_paint(const geometry::PitchSize& pitch, Random& random) {
  const double length = random.uniform(8, 30),
               angle = random.chance(0.7) ? M_PI / 2 * random.integer(0, 1) : random.uniform(0, M_PI);
  const Vector<2> along(std::cos(angle), std::sin(angle)), middle = random.uniform_pair(0, pitch.length, 0, pitch.width);
  geometry::PitchLine line;
  line.name = "other";
  for (double at = 0; at <= length; at += 0.5) {
    line.points.push_back(middle + (at - length / 2) * along);
    line.tangents.push_back(along);
  }
  return line;
}

void draw_boards(cv::Mat wall, Random& random) {
  const int top = wall.rows - static_cast<int>(kBoardHigh / kWallTexel);
  for (int x = 0; x < wall.cols;) {
    const int width = random.integer(60, 110);
    const cv::Rect board = cv::Rect(x, top, width, wall.rows - top) & cv::Rect({}, wall.size());
    const double red = random.uniform(20, 200), green = random.uniform(20, 200), blue = random.uniform(20, 200);
    const cv::Scalar back(blue, green, red);
    const double bright = back[0] + back[1] + back[2] > 330 ? 30 : 225;
    wall(board) = back;
    std::string word;
    for (int i = random.integer(3, 7); i > 0; --i) word += static_cast<char>('A' + random.integer(0, 25));
    cv::putText(wall, word, {x + 4, wall.rows - 4}, cv::FONT_HERSHEY_SIMPLEX, 0.42, cv::Scalar(bright, bright, bright), 1,
                cv::LINE_AA);
    x += width;
  }
}

/// Rows of seats with people in clothes of all colours, steps between the blocks, then a roof and the sky.
void draw_stand(cv::Mat wall, Random& random) {
  wall = cv::Scalar(226, 206, 196);
  const auto row_of = [&](double high) { return wall.rows - 1 - static_cast<int>(high / kWallTexel); };
  wall(cv::Range(row_of(kStandHigh + 2), row_of(kStandHigh)), cv::Range::all()) = cv::Scalar(70, 66, 62);
  wall(cv::Range(row_of(kStandHigh), wall.rows), cv::Range::all()) = cv::Scalar(64, 58, 56);
  for (double high = kBoardHigh + 0.5; high < kStandHigh - 0.5; high += 0.45) {
    for (double along = 0; along < wall.cols * kWallTexel; along += 0.5) {
      if (std::fmod(along, 14) < 1.2 || random.chance(0.25)) continue;
      const cv::Point at(static_cast<int>((along + random.uniform(-0.1, 0.1)) / kWallTexel), row_of(high));
      const double bright = random.uniform(0.4, 1);
      const double red = random.uniform(30, 230), green = random.uniform(30, 210), blue = random.uniform(30, 230);
      cv::ellipse(wall, at, {3, 4}, 0, 0, 360, bright * cv::Scalar(blue, green, red), cv::FILLED, cv::LINE_AA);
    }
  }
}

/// A place of the texture for one ray, as columns and rows of the whole.
struct Lookup {
  Lookup(const geometry::PitchSize& pitch, const Vector<3>& from) : extent(pitch), size(pitch), centre(from) {}

  cv::Point2f operator()(const Vector<3>& ray) const {
    const double ground = ray.z() < 0 ? -centre.z() / ray.z() : 1e9;
    const double far = ray.y() > 1e-9 ? (size.width + kRound - centre.y()) / ray.y() : 1e9;
    const double side = std::abs(ray.x()) < 1e-9 ? 1e9
                        : ray.x() < 0            ? (-kRound - centre.x()) / ray.x()
                                                 : (size.length + kRound - centre.x()) / ray.x();
    if (ground < far && ground < side) {
      const Vector<2> at = centre.head<2>() + ground * ray.head<2>();
      return {static_cast<float>((at.x() + kRound) / kTexel - 0.5), static_cast<float>((at.y() + kNear) / kTexel - 0.5)};
    }
    const double distance = std::min(far, side);
    const Vector<3> at = centre + distance * ray;
    double along = extent.depth + at.x() + kRound;  // along the far wall; the left one before it, the right one after it
    if (side < far) along = ray.x() < 0 ? at.y() + kNear : extent.depth + extent.across + (size.width + kRound - at.y());
    const double column = std::clamp(along / kWallTexel - 0.5, 0.0, extent.wall.width - 1.0);
    const double row = std::clamp((kWallHigh - at.z()) / kWallTexel - 0.5, 0.0, extent.wall.height - 1.0);
    return {static_cast<float>(column), static_cast<float>(extent.ground.height + row)};
  }

  Extent extent;
  geometry::PitchSize size;
  Vector<3> centre;
};

}  // namespace

PtzBackground::PtzBackground(const geometry::PitchSize& pitch, std::uint64_t seed, const PtzPaint& paint)
    : pitch_(pitch),
      appearance_(paint),
      seed_(seed),
      lines_(paint.hockey ? hockey_lines(pitch) : geometry::pitch_lines(pitch, 0.5)) {
  const Extent extent(pitch);
  Random random(seed * 2654435761u + 81), painter(seed * 2654435761u + 82);
  for (int i = 0; i < paint.extra; ++i) lines_.push_back(other_paint(pitch, painter));
  for (int i = 0; i < paint.junior; ++i) {
    for (geometry::PitchLine& line : junior_lines(pitch, i == 1)) lines_.push_back(std::move(line));
  }
  texture_.create(extent.ground.height + extent.wall.height, std::max(extent.ground.width, extent.wall.width), CV_8UC3);
  texture_ = cv::Scalar::all(0);
  cv::Mat ground = texture_(cv::Rect({}, extent.ground));
  draw_grass(ground, pitch, paint.mowing, seed);
  if (paint.mats) lay_mats(ground, pitch);
  if (paint.wet > 0) wet_grass(ground, paint.wet, seed);
  // A pixel is some decimetres deep on the ground: what it would alias is blurred away.
  cv::GaussianBlur(ground.clone(), ground, {1, 5}, 0.01, 1.1);
  cv::Mat wall = texture_(cv::Rect({0, extent.ground.height}, extent.wall));
  draw_stand(wall, random);
  draw_boards(wall, random);
  cv::GaussianBlur(wall.clone(), wall, {3, 3}, 0.6);
}

cv::Mat PtzBackground::texture_of(const Camera& camera) const {
  const cv::Size size = camera.size();
  const Lookup lookup(pitch_, camera.centre());
  const Matrix<3> to_world = camera.camera_from_world().rotation.transpose();
  const int columns = size.width / kRayGrid + 2, rows = size.height / kRayGrid + 2;
  std::vector<Vector<3>> rays;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const auto bearing = camera.bearing({static_cast<double>(column * kRayGrid), static_cast<double>(row * kRayGrid)});
      rays.push_back(bearing ? Vector<3>(to_world * *bearing) : Vector<3>(Vector<3>::UnitZ()));
    }
  }
  cv::Mat locations(size, CV_32FC2), image;
  cv::parallel_for_(cv::Range(0, size.height), [&](const cv::Range& range) {
    for (int y = range.start; y < range.end; ++y) {
      const auto* above = &rays[static_cast<std::size_t>(y / kRayGrid * columns)];
      const double b = static_cast<double>(y % kRayGrid) / kRayGrid;
      auto* out = locations.ptr<cv::Point2f>(y);
      for (int x = 0; x < size.width; ++x) {
        const int c = x / kRayGrid;
        const double a = static_cast<double>(x % kRayGrid) / kRayGrid;
        out[x] = lookup((1 - b) * ((1 - a) * above[c] + a * above[c + 1]) +
                        b * ((1 - a) * above[columns + c] + a * above[columns + c + 1]));
      }
    }
  });
  cv::remap(texture_, image, locations, {}, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return image;
}

/// The share of each pixel that is paint, CV_8UC1.
cv::Mat PtzBackground::paint(const Camera& camera) const {
  cv::Mat fine(camera.size() * kSuper, CV_8UC1, cv::Scalar(0)), fraction;
  const Box reach{-200, -200, camera.size().width + 400.0, camera.size().height + 400.0};
  // Of a fine image whose pixel i has its centre at (i + 0.5) / kSuper − 0.5.
  const auto corner = [&](const Vector<2>& at) -> std::optional<cv::Point> {
    const auto pixel = camera.project({at.x(), at.y(), 0});
    if (!pixel || pixel->x() < reach.left || pixel->x() > reach.right() || pixel->y() < reach.top || pixel->y() > reach.bottom())
      return std::nullopt;
    const Vector<2> there = ((pixel->array() + 0.5) * kSuper - 0.5) * (1 << kFixed);
    return cv::Point(cvRound(there.x()), cvRound(there.y()));
  };
  const double worn_level = 2 * appearance_.missing - 1;  // of value_noise, roughly even in −1 … 1
  for (const geometry::PitchLine& line : lines_) {
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
      constexpr double kWorn = 3;  // m
      if (appearance_.missing > 0 && value_noise(line.points[i] / kWorn, seed_ + 21) < worn_level) continue;
      const auto edge_point = [&](std::size_t k, double side) {
        const Vector<2>& along = line.tangents[k];
        return corner(line.points[k] + side * appearance_.width / 2 * Vector<2>(-along.y(), along.x()));
      };
      const auto a = edge_point(i, 1), b = edge_point(i + 1, 1), c = edge_point(i + 1, -1), d = edge_point(i, -1);
      if (!a || !b || !c || !d) continue;
      const std::array<cv::Point, 4> four{*a, *b, *c, *d};
      cv::fillConvexPoly(fine, four.data(), 4, cv::Scalar(255), cv::LINE_8, kFixed);
    }
  }
  cv::resize(fine, fraction, camera.size(), 0, 0, cv::INTER_AREA);
  return fraction;
}

cv::Mat PtzBackground::draw(const Camera& camera) const {
  cv::Mat image = texture_of(camera);
  const cv::Mat fraction = paint(camera);
  for (int y = 0; y < image.rows; ++y) {
    auto* row = image.ptr<cv::Vec3b>(y);
    const auto* cover = fraction.ptr<std::uint8_t>(y);
    for (int x = 0; x < image.cols; ++x) {
      if (cover[x] == 0) continue;
      const double part = appearance_.contrast * cover[x] / 255.0, bright = 0.6 + 0.4 * row[x][1] / 100.0;
      const cv::Vec3b white = shaded(206, 213, 208, bright);
      for (int i = 0; i < 3; ++i) row[x][i] = cv::saturate_cast<std::uint8_t>((1 - part) * row[x][i] + part * white[i]);
    }
  }
  return image;
}

}  // namespace marey::simulate::match

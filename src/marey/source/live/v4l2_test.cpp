// V4L2 by a kernel that the test plays itself: formats, odd strides, gaps, broken frames, a camera that is pulled out.
#include "marey/source/live/v4l2.h"

#include <cerrno>
#include <cstring>
#include <deque>
#include <memory>
#include <vector>

#include <gtest/gtest.h>
#include <linux/videodev2.h>
#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"

namespace marey::source::live {
namespace {

struct FakeDelivery {
  int error = 0;  // −errno of DQBUF
  std::uint32_t sequence = 0, flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC;
  std::vector<std::uint8_t> bytes = {};
  double age_s = 0.01;
};

class FakeKernel final : public Kernel {
 public:
  std::vector<std::uint32_t> formats{V4L2_PIX_FMT_YUYV, V4L2_PIX_FMT_GREY};
  std::uint32_t width = 6, height = 4, stride = 0;
  std::deque<FakeDelivery> coming;
  int open_files = 0, mapped = 0, queued = 0;
  bool streaming = false, busy = false;
  std::vector<std::pair<std::uint32_t, int>> controls;

  int open(const std::string& path) override {
    if (path != "/dev/video7") return -ENOENT;
    if (busy) return -EBUSY;
    ++open_files;
    return 3;
  }
  void close(int) override { --open_files; }
  void* map(int, std::size_t length, std::int64_t offset) override {
    ++mapped;
    memory_.resize(4, std::vector<std::uint8_t>(length));
    return memory_[static_cast<std::size_t>(offset) / 65536].data();
  }
  void unmap(void*, std::size_t) override { --mapped; }
  int wait(int, int) override { return coming.empty() ? 0 : 1; }
  Duration now() override { return std::chrono::seconds(5000); }
  std::vector<std::string> devices() override { return {"/dev/video0", "/dev/video7"}; }

  int control(int, unsigned long request, void* argument) override {
    switch (request) {
      case VIDIOC_QUERYCAP: {
        auto& can = *static_cast<v4l2_capability*>(argument);
        std::strcpy(reinterpret_cast<char*>(can.card), "Fake eye");
        can.capabilities = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
        return 0;
      }
      case VIDIOC_ENUM_FMT: {
        auto& each = *static_cast<v4l2_fmtdesc*>(argument);
        if (each.index >= formats.size()) return -EINVAL;
        each.pixelformat = formats[each.index];
        return 0;
      }
      case VIDIOC_G_FMT:
      case VIDIOC_S_FMT: {
        auto& pix = static_cast<v4l2_format*>(argument)->fmt.pix;
        pix.width = width;
        pix.height = height;
        pix.bytesperline = stride;
        return 0;
      }
      case VIDIOC_S_PARM:
      case VIDIOC_G_PARM:
        static_cast<v4l2_streamparm*>(argument)->parm.capture.timeperframe = {1, 50};
        return 0;
      case VIDIOC_QUERYCTRL: {
        auto& query = *static_cast<v4l2_queryctrl*>(argument);
        if (query.id != V4L2_CID_EXPOSURE_ABSOLUTE) return -EINVAL;
        query.minimum = 1;
        query.maximum = 300;
        return 0;
      }
      case VIDIOC_G_CTRL:
        static_cast<v4l2_control*>(argument)->value = controls.empty() ? 50 : controls.back().second;
        return 0;
      case VIDIOC_S_CTRL: {
        const auto& set = *static_cast<v4l2_control*>(argument);
        if (set.value > 300) return -ERANGE;
        controls.emplace_back(set.id, set.value);
        return 0;
      }
      default:
        return stream(request, argument);
    }
  }

 private:
  int stream(unsigned long request, void* argument) {
    switch (request) {
      case VIDIOC_REQBUFS:
        return 0;
      case VIDIOC_QUERYBUF: {
        auto& buffer = *static_cast<v4l2_buffer*>(argument);
        buffer.length = 65536;
        buffer.m.offset = buffer.index * 65536;
        return 0;
      }
      case VIDIOC_QBUF:
        ++queued;
        return 0;
      case VIDIOC_STREAMON:
      case VIDIOC_STREAMOFF:
        streaming = request == VIDIOC_STREAMON;
        return 0;
      case VIDIOC_DQBUF:
        return deliver(*static_cast<v4l2_buffer*>(argument));
      default:
        return -EINVAL;
    }
  }

  int deliver(v4l2_buffer& buffer) {
    const FakeDelivery now = coming.front();
    coming.pop_front();
    if (now.error != 0) return now.error;
    buffer.index = now.sequence % 4;
    std::copy(now.bytes.begin(), now.bytes.end(), memory_[buffer.index].begin());
    buffer.bytesused = static_cast<std::uint32_t>(now.bytes.size());
    buffer.sequence = now.sequence;
    buffer.flags = now.flags;
    const auto stamp =
        std::chrono::duration_cast<std::chrono::microseconds>(this->now() - duration_from_seconds(now.age_s)).count();
    buffer.timestamp = {stamp / 1'000'000, stamp % 1'000'000};
    --queued;
    return 0;
  }

  std::vector<std::vector<std::uint8_t>> memory_;
};

class V4l2Test : public testing::Test {
 protected:
  std::unique_ptr<Connection> connect(const std::string& name) {
    return connect_v4l2(v4l2_options(parse_address(name), std::nullopt), kernel_)(*time_, {});
  }
  std::vector<std::uint8_t> grey(std::size_t stride) const {
    std::vector<std::uint8_t> bytes(3 * stride + 6, 255);
    for (std::size_t y = 0; y < 4; ++y) {
      for (std::size_t x = 0; x < 6; ++x) bytes[y * stride + x] = static_cast<std::uint8_t>(10 * y + x);
    }
    return bytes;
  }

  std::shared_ptr<FakeKernel> kernel_ = std::make_shared<FakeKernel>();
  std::shared_ptr<LiveTime> time_ = steady_time();
};

TEST_F(V4l2Test, GreyWithRowsThatAreLongerThanThePicture) {
  kernel_->stride = 11;
  const auto camera = connect("v4l2:/dev/video7");
  EXPECT_EQ(camera->info().size, cv::Size(6, 4));
  EXPECT_EQ(camera->info().rate_hz, 50);
  kernel_->coming.push_back({.sequence = 8, .bytes = grey(11)});
  Shot shot;
  ASSERT_EQ(camera->next(shot), Came::frame);
  const cv::Mat& luma = shot.given.frame.image.luma();
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 6; ++x) EXPECT_EQ(luma.at<std::uint8_t>(y, x), 10 * y + x);
  }
  EXPECT_EQ(shot.sequence, 8);
  EXPECT_NEAR(seconds(time_->now() - *shot.taken), 0.01, 0.005) << "when the driver says, not when it came";
  EXPECT_EQ(camera->next(shot), Came::nothing);
}

TEST_F(V4l2Test, YuyvKeepsItsColours) {
  const auto camera = connect("v4l2:/dev/video7?format=YUYV");
  std::vector<std::uint8_t> bytes;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 3; ++x) bytes.insert(bytes.end(), {81, 90, 81, 240});  // red
  }
  kernel_->coming.push_back({.sequence = 0, .bytes = bytes});
  Shot shot;
  ASSERT_EQ(camera->next(shot), Came::frame);
  const auto colour = shot.given.frame.image.bgr().at<cv::Vec3b>(2, 3);
  EXPECT_LT(colour[0], 8);
  EXPECT_LT(colour[1], 8);
  EXPECT_GT(colour[2], 247);
}

TEST_F(V4l2Test, JpegIsDecodedAndWhatIsNoneIsDamaged) {
  kernel_->formats = {V4L2_PIX_FMT_MJPEG};
  const auto camera = connect("v4l2:/dev/video7");
  kernel_->coming.push_back({.sequence = 0, .bytes = {0xff, 0xd8, 1, 2, 3}});
  Shot shot;
  EXPECT_EQ(camera->next(shot), Came::damaged);
  EXPECT_EQ(kernel_->queued, 4) << "the buffer went back";
}

TEST_F(V4l2Test, ShortAndBrokenFramesAreDamagedAndGapsAreSeen) {
  const auto camera = connect("v4l2:/dev/video7");
  kernel_->coming.push_back({.sequence = 4294967294u, .bytes = grey(6)});
  kernel_->coming.push_back({.sequence = 4294967295u, .bytes = {1, 2, 3}});
  kernel_->coming.push_back({.sequence = 0, .flags = V4L2_BUF_FLAG_ERROR, .bytes = grey(6)});
  kernel_->coming.push_back({.error = -EIO});
  kernel_->coming.push_back({.error = -EAGAIN});
  kernel_->coming.push_back({.sequence = 3, .bytes = grey(6)});
  Shot shot;
  ASSERT_EQ(camera->next(shot), Came::frame);
  const std::int64_t first = *shot.sequence;
  EXPECT_EQ(camera->next(shot), Came::damaged);
  EXPECT_EQ(camera->next(shot), Came::damaged);
  EXPECT_EQ(camera->next(shot), Came::damaged);
  EXPECT_EQ(camera->next(shot), Came::nothing);
  EXPECT_EQ(camera->next(shot), Came::frame);
  EXPECT_EQ(*shot.sequence - first, 5) << "numbers of 32 bits that began again";
}

TEST_F(V4l2Test, UnpluggedCameraIsErrorAndClosed) {
  auto camera = connect("v4l2:/dev/video7?exposure=5&gain=20");
  EXPECT_EQ(kernel_->controls,
            (std::vector<std::pair<std::uint32_t, int>>{
                {V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL}, {V4L2_CID_EXPOSURE_ABSOLUTE, 50}, {V4L2_CID_GAIN, 20}}));
  kernel_->coming.push_back({.error = -ENODEV});
  Shot shot;
  EXPECT_THROW(camera->next(shot), Error);
  camera.reset();
  EXPECT_EQ(kernel_->open_files, 0);
  EXPECT_EQ(kernel_->mapped, 0);
  EXPECT_FALSE(kernel_->streaming);
}

TEST_F(V4l2Test, ItsExposureIsSetWhileItGivesPictures) {
  const auto camera = connect("v4l2:/dev/video7");
  const auto has = camera->controls();
  ASSERT_EQ(has.size(), 1u) << "it has no gain";
  EXPECT_EQ(has[0].control, Control::exposure);
  EXPECT_NEAR(has[0].minimum, 0.1, 1e-12);
  EXPECT_NEAR(has[0].maximum, 30, 1e-12);
  EXPECT_NEAR(has[0].now, 5, 1e-12);
  camera->set(Control::exposure, 2.5);
  EXPECT_EQ(kernel_->controls, (std::vector<std::pair<std::uint32_t, int>>{{V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL},
                                                                           {V4L2_CID_EXPOSURE_ABSOLUTE, 25}}));
  EXPECT_NEAR(camera->controls()[0].now, 2.5, 1e-12);
  EXPECT_THROW(camera->set(Control::exposure, 31), Error);
  EXPECT_THROW(camera->set(Control::exposure, 1e300), Error);
}

TEST_F(V4l2Test, RejectsImpossibleSettings) {
  EXPECT_THROW(connect("v4l2:/dev/video3"), Error);
  EXPECT_THROW(connect("v4l2:/dev/video7?format=MJPG"), Error) << "it has none";
  EXPECT_THROW(connect("v4l2:/dev/video7?format=H264"), Error);
  EXPECT_THROW(connect("v4l2:/dev/video7?size=1920x1080"), Error) << "it gives 6 x 4";
  EXPECT_THROW(connect("v4l2:/dev/video7?colour=red"), Error);
  kernel_->busy = true;
  EXPECT_THROW(connect("v4l2:/dev/video7"), Error);
  EXPECT_EQ(kernel_->open_files, 0);
}

TEST_F(V4l2Test, ListsWhatIsPluggedIn) {
  const auto found = find_v4l2(*kernel_);
  ASSERT_EQ(found.size(), 1u) << "/dev/video0 cannot be opened";
  EXPECT_EQ(found[0].source, "v4l2:/dev/video7");
  EXPECT_EQ(found[0].name, "Fake eye");
}

}  // namespace
}  // namespace marey::source::live

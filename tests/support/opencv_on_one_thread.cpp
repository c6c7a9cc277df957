// Linked to tests under the thread sanitizer, which does not see the waiting for tasks within OpenCV's own library.
#include <opencv2/core/utility.hpp>

namespace {

[[maybe_unused]] const bool kOnOneThread = (cv::setNumThreads(1), true);

}  // namespace

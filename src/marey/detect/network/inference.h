// OpenCV's dnn behind one source: its header and what is instantiated of it stay there.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/detect/network/output_layout.h"

namespace marey::detect::network {

/// A network, loaded once for each thread that computes with it. The same input gives the same bits on any number of threads.
class Inference {
 public:
  /// One thread's copy.
  class Engine {
   public:
    explicit Engine(const std::string& onnx);
    ~Engine();
    /// `blob`: 1 × channels × height × width floats; `wanted`: outputs by name, all where it is empty. Throws cv::Exception.
    std::vector<Tensor> run(const cv::Mat& blob, std::span<const std::string> required = {});

   private:
    struct Net;
    std::unique_ptr<Net> net_;
  };

  /// From an ONNX file, whose weights may be of 16 bits. Throws Error if it cannot be loaded, with what to do then.
  explicit Inference(std::string onnx, std::string remedy = "export it with opset 11 or 12 and a fixed input");
  ~Inference();
  Inference(Inference&&) noexcept;

  /// Calls `work` for 0 to `count` - 1, on as many threads as OpenCV has (--threads), one engine each. Within it OpenCV writes
  /// nothing to standard error, and each network is computed on one thread where there is work for several.
  void each(std::size_t count, const std::function<void(Engine&, std::size_t)>& work);

 private:
  std::unique_ptr<Engine> load() const;

  std::string onnx_, remedy_;
  std::vector<std::unique_ptr<Engine>> engines_;  // loaded when they are needed
};

/// What OpenCV said in an exception: its sentence without file and line, and only its first line.
std::string reason_of(const cv::Exception& error);

}  // namespace marey::detect::network

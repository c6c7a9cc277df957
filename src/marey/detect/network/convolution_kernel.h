#pragma once

namespace marey::detect::network {

/// Rows of one channel: what belongs to output x of tap k is taps[row][k][x].
struct DepthwiseRows {
  static constexpr int kMaxTaps = 5;  ///< numerical: OpenCV computes larger kernels
  const float* taps[kMaxTaps][kMaxTaps] = {};
};

/// The inner loops of convolutions. Results are held in [low, high].
struct ConvolutionKernels {
  static constexpr int kBlock = 32;  ///< numerical, time alone: pixels that are computed together, at most
  static constexpr int kRows = 6;    ///< output channels that are computed together

  /// By channel, `size` × `size` taps (3 or 5): out[x] = bias + Σ weights · taps. What stands behind a row's last value is read up
  /// to the next multiple of kBlock, and written: there must be room.
  void (*by_channel)(const DepthwiseRows& rows, const float* weights, int size, float bias, float low, float high, int width,
                     float* out);

  /// 1 × 1: of kRows output channels and kBlock pixels, out[r · stride + x] = bias[r] + Σ weights[i · kRows + r] · pixels[i ·
  /// kBlock + x] over `inputs` channels i.
  void (*point)(const float* pixels, const float* weights, int inputs, const float* bias, float low, float high, float* out,
                int stride);
};

/// The fastest that this machine runs.
const ConvolutionKernels& convolution_kernels();

}  // namespace marey::detect::network

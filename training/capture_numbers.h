// The numbers of a batch's captures as tensors. Include from .cc files only: pulls in torch.
#pragma once

#include <torch/torch.h>

#include <functional>
#include <vector>

#include "training/capture_draw.h"

namespace glint {

// All numbers that pictures are made with, copied to the device at once (layers/staging.h). Every
// capture has the same number of shots.
class CaptureNumbers {
 public:
  CaptureNumbers(const std::vector<DrawnCapture>& captures, const torch::TensorOptions& options);

  // One number of every shot, [B, N, 1, 1, 1]. Numbers of captures are those of all their shots.
  torch::Tensor operator()(double Disturbance::*field) const;
  torch::Tensor operator()(double Shot::*field) const;
  torch::Tensor operator()(double DrawnCapture::*field) const;

 private:
  torch::Tensor Column(size_t k) const;
  torch::Tensor all_;  // [B, N, columns, 1, 1]
};

// Some of a batch's captures; the host knows which.
struct CaptureSubset {
  std::vector<size_t> numbers;
  torch::Tensor index;  // the same on the device, int64

  CaptureSubset(const std::vector<DrawnCapture>& captures, const torch::TensorOptions& options,
                const std::function<bool(const DrawnCapture&)>& is_in);
  bool empty() const { return numbers.empty(); }
  torch::Tensor Of(const torch::Tensor& of_captures) const;  // its rows
  // `of_captures` with the subset's rows replaced.
  torch::Tensor Replaced(const torch::Tensor& of_captures, const torch::Tensor& rows) const;
};

}  // namespace glint

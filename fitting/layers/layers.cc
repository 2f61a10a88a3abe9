#include "fitting/layers/layers.h"

#include <cstring>
#include <vector>

#include "base/cpu/instruction_set.h"

namespace glint {
namespace {

using torch::Tensor;

// Copies between the layouts of Interleave: `wide` [n, h+1, w+1, 2, 2, c], `fine` [n, 2h, 2w, c],
// both contiguous, elements of any type. Output row m reads wide row (m+1)/2, phase (m+1)%2.
template <bool kToFine>
void CopyPhases(char* wide, char* fine, int64_t n, int64_t h, int64_t w, int64_t run_bytes) {
  at::parallel_for(0, n * 2 * h, 1, [&](int64_t begin, int64_t end) {
    for (int64_t row = begin; row < end; ++row) {
      const int64_t image = row / (2 * h), m = row % (2 * h) + 1;
      char* wide_row = wide + ((image * (h + 1) + m / 2) * (w + 1) * 4 + (m % 2) * 2) * run_bytes;
      char* fine_row = fine + row * 2 * w * run_bytes;
      for (int64_t q = 1; q <= 2 * w; ++q) {
        char* a = wide_row + ((q / 2) * 4 + q % 2) * run_bytes;
        char* b = fine_row + (q - 1) * run_bytes;
        if constexpr (kToFine) {
          std::memcpy(b, a, run_bytes);
        } else {
          std::memcpy(a, b, run_bytes);
        }
      }
    }
  });
}

// Pixel shuffle of [n, 4·c, h+1, w+1] (channel = phase·c + k) and a crop by one on each side, to
// [n, c, 2h, 2w]; channels-last in and out, one pass over memory.
class Interleave : public torch::autograd::Function<Interleave> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& input) {
    const Tensor x = input.contiguous(torch::MemoryFormat::ChannelsLast);
    const int64_t n = x.size(0), c = x.size(1) / 4, h = x.size(2) - 1, w = x.size(3) - 1;
    Tensor out = torch::empty({n, c, 2 * h, 2 * w},
                              x.options().memory_format(torch::MemoryFormat::ChannelsLast));
    CopyPhases<true>(static_cast<char*>(x.data_ptr()), static_cast<char*>(out.data_ptr()), n, h, w,
                     c * static_cast<int64_t>(x.element_size()));
    context->saved_data["shape"] = x.sizes();
    return out;
  }

  static torch::autograd::tensor_list backward(torch::autograd::AutogradContext* context,
                                               torch::autograd::tensor_list gradients) {
    const Tensor g = gradients[0].contiguous(torch::MemoryFormat::ChannelsLast);
    Tensor out = torch::zeros(context->saved_data["shape"].toIntVector(), g.options())
                     .contiguous(torch::MemoryFormat::ChannelsLast);
    CopyPhases<false>(static_cast<char*>(out.data_ptr()), static_cast<char*>(g.data_ptr()),
                      g.size(0), g.size(2) / 2, g.size(3) / 2,
                      g.size(1) * static_cast<int64_t>(g.element_size()));
    return {out};
  }
};

}  // namespace

Tensor AsType(const Tensor& t, torch::Dtype type) {
  return t.to(type, false, false, torch::MemoryFormat::ChannelsLast);  // one pass for both
}

Tensor DownConvolve(const Tensor& x, const Tensor& weight, const Tensor& bias,
                    torch::Dtype compute) {
  return at::conv2d(x, AsType(weight, compute), bias.to(compute), 2, 1);
}

Tensor InterleavedByTorch(const Tensor& wide) {
  const int64_t n = wide.size(0), c = wide.size(1) / 4, h = wide.size(2), w = wide.size(3);
  return wide.contiguous()
      .view({n, 2, 2, c, h, w})
      .permute({0, 3, 4, 1, 5, 2})
      .reshape({n, c, 2 * h, 2 * w})
      .slice(2, 1, 2 * h - 1)
      .slice(3, 1, 2 * w - 1)
      .contiguous(torch::MemoryFormat::ChannelsLast);
}

Tensor UpConvolve(const Tensor& x, const Tensor& weight, const Tensor& bias, torch::Dtype compute) {
  const Tensor wide = at::conv2d(x, AsType(weight, compute), bias.to(compute), 1, 1);
  return wide.device().is_cpu() ? Interleave::apply(wide) : InterleavedByTorch(wide);
}

// A 3×3 kernel [out, in, 3, 3] after nearest upsampling, as the 2×2 kernels of the four phases.
// Output 2i sees input i−1 with the first tap and i with the other two; output 2i+1 sees i with the
// first two and i+1 with the last. Phase 1 of wide row i is output 2i, phase 0 of wide row i+1 is
// output 2i+1.
Tensor PhaseKernels(const Tensor& kernel) {
  std::vector<Tensor> phases;
  for (int a = 0; a < 2; ++a) {
    for (int b = 0; b < 2; ++b) {
      const auto fold = [](const Tensor& t, int dim, int phase) {
        const Tensor first = t.select(dim, 0), mid = t.select(dim, 1), last = t.select(dim, 2);
        return phase == 1 ? torch::stack({first, mid + last}, dim)
                          : torch::stack({first + mid, last}, dim);
      };
      phases.push_back(fold(fold(kernel, 2, a), 3, b));
    }
  }
  return torch::cat(phases, 0);
}

torch::Dtype FastComputeType(torch::Device device) {
  return !device.is_cpu() || NativeBfloat16() ? torch::kBFloat16 : torch::kFloat32;
}

}  // namespace glint

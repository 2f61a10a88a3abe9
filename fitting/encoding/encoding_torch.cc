#include "fitting/encoding/encoding_torch.h"

#include <algorithm>

#include "base/reflectance/svbrdf_maps.h"

namespace glint {
namespace {

using torch::Tensor;

class DecodeFunction : public torch::autograd::Function<DecodeFunction> {
 public:
  static Tensor forward(torch::autograd::AutogradContext* context, const Tensor& input) {
    const Tensor encoded = input.contiguous();
    const auto texels = static_cast<size_t>(encoded.size(2) * encoded.size(3));
    Tensor maps = torch::empty({encoded.size(0), kSvbrdfPlanes, encoded.size(2), encoded.size(3)},
                               encoded.options().memory_format(torch::MemoryFormat::Contiguous));
    for (int64_t b = 0; b < encoded.size(0); ++b) {
      DecodeTexels(encoded[b].data_ptr<float>(), texels, maps[b].data_ptr<float>());
    }
    context->save_for_backward({encoded});
    return maps;
  }

  static torch::autograd::tensor_list backward(torch::autograd::AutogradContext* context,
                                               torch::autograd::tensor_list gradients) {
    const Tensor encoded = context->get_saved_variables()[0];
    const Tensor gradient = gradients[0].contiguous();
    const auto texels = static_cast<size_t>(encoded.size(2) * encoded.size(3));
    Tensor out = torch::empty_like(encoded);
    for (int64_t b = 0; b < encoded.size(0); ++b) {
      DecodeTexelsAdjoint(encoded[b].data_ptr<float>(), gradient[b].data_ptr<float>(), texels,
                          out[b].data_ptr<float>());
    }
    return {out};
  }
};

}  // namespace

Tensor DecodeTexelsTorch(const Tensor& encoded) {
  TORCH_CHECK(encoded.dim() == 4 && encoded.size(1) == kEncodedChannels &&
                  encoded.scalar_type() == torch::kFloat32,
              "encoded: [B, 9, H, W] of float32 is expected");
  return encoded.device().is_cpu() ? DecodeFunction::apply(encoded)
                                   : DecodeTexelsReference(encoded);
}

Tensor DecodeTexelsReference(const Tensor& encoded) {
  const Tensor t = encoded.clamp(-1.0, 1.0);
  const Tensor colours = (0.5 * (t.slice(1, 0, kEncodedRoughness) + 1.0)).square();
  const Tensor u = 0.5 * (t.slice(1, kEncodedRoughness, kEncodedNormal) + 1.0);
  const Tensor roughness = double{kMinRoughness} + (1.0 - double{kMinRoughness}) * u;
  const Tensor t_xy = t.slice(1, kEncodedNormal, kEncodedChannels);
  const Tensor slopes = t_xy * (1.0 + 3.0 * t_xy.square());
  const Tensor z = torch::rsqrt(slopes.square().sum(1, true) + 1.0);
  return torch::cat({slopes * z, z, colours, roughness}, 1);
}

EncodedMaps CroppedMaps(const Tensor& encoded, int width, int height) {
  EncodedMaps maps(width, height);
  const Tensor all = encoded.contiguous();
  const int64_t full_height = all.size(2), full_width = all.size(3);
  const float* from = all.data_ptr<float>();
  float* to = maps.planes.data();
  for (int p = 0; p < kEncodedChannels; ++p) {
    for (int row = 0; row < height; ++row, to += width) {
      std::copy_n(from + (p * full_height + row) * full_width, width, to);
    }
  }
  return maps;
}

}  // namespace glint

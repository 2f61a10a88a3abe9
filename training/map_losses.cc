#include "training/map_losses.h"

#include "fitting/encoding/encoding.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/render/render_autograd.h"
#include "training/random.h"
#include "training/render_loss.h"

namespace glint {
namespace {

using torch::Tensor;

constexpr std::uint64_t kViewStream = 0x5EED0002;

}  // namespace

Tensor MapWeights(const TrainOptions& options) {
  Tensor w = torch::ones({1, kEncodedChannels, 1, 1});
  w.slice(1, kEncodedNormal, kEncodedChannels).fill_(options.normal_weight);
  return w / w.mean();
}

Tensor RenderLossOf(const Tensor& decoded, const Tensor& truth, const TrainOptions& options,
                    std::int64_t step) {
  ViewBatch batch;
  batch.plane = {static_cast<int>(truth.size(3)), static_cast<int>(truth.size(2)), 2.0, 2.0,
                 TexelSampling::kPixelCentres};
  batch.convention = {DiffuseWeight::kOne, LightFalloff::kNone, TexelSampling::kPixelCentres};
  batch.views_per_element = options.render_views;
  Stream random(StreamSeed(options.seed ^ kViewStream, static_cast<std::uint64_t>(step)));
  for (int64_t b = 0; b < truth.size(0); ++b) {
    const std::vector<View> views = DrawRenderLossViews(&random, options.render_views);
    batch.views.insert(batch.views.end(), views.begin(), views.end());
  }
  return LogLossBetweenMaps(DecodeTexelsTorch(decoded), DecodeTexelsTorch(truth), batch, {});
}

}  // namespace glint

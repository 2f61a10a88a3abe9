#include "fitting/estimator/estimator.h"

#include <algorithm>

#include "base/parallel/parallel.h"
#include "base/resampling/resampling.h"
#include "fitting/encoding/decoded_deviations.h"
#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/estimator_file.h"
#include "fitting/estimator/photograph_features.h"
#include "fitting/layers/threads.h"

namespace glint {
namespace {

using torch::Tensor;

int Padded(int n) {
  return (n + kEstimatorDownsampling - 1) / kEstimatorDownsampling * kEstimatorDownsampling;
}

// `to`: [11, height, width].
void CopyPadded(const PhotographFeatures& features, int height, int width, float* to) {
  const size_t texels = static_cast<size_t>(features.width) * features.height;
  for (int p = 0; p < kFeaturePlanes; ++p) {
    for (int row = 0; row < height; ++row) {
      const float* from = features.planes.data() + p * texels +
                          static_cast<size_t>(std::min(row, features.height - 1)) * features.width;
      for (int column = 0; column < width; ++column) {
        *to++ = from[std::min(column, features.width - 1)];
      }
    }
  }
}

// What the network is shown of photographs: [1, N, 11, H, W] and [1, N, 72].
struct Shown {
  Tensor features, profiles;
};

Shown ShownOf(const PhotographSet& set, int threads) {
  const auto count = static_cast<int64_t>(set.photographs.size());
  const int height = Padded(set.plane.height), width = Padded(set.plane.width);
  Shown shown{torch::empty({1, count, kFeaturePlanes, height, width}),
              torch::empty({1, count, kProfileValues})};
  ForEachPiece(static_cast<int>(count), threads, [&](int i) {
    const PhotographFeatures one =
        FeaturesOf(set.photographs[static_cast<size_t>(i)], set.plane, set.convention);
    CopyPadded(one, height, width, shown.features[0][i].data_ptr<float>());
    std::copy(one.profile.begin(), one.profile.end(), shown.profiles[0][i].data_ptr<float>());
  });
  return shown;
}

}  // namespace

struct Estimator::Impl {
  EstimatorNetwork network;
};

Estimator::Estimator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;

Estimator Estimator::Load(const std::filesystem::path& weights) {
  return Estimator(std::make_unique<Impl>(Impl{LoadEstimator(weights)}));
}

SvbrdfEstimate Estimator::Estimate(const PhotographSet& set, const EstimatorConditions& conditions,
                                   int threads) const {
  torch::NoGradGuard no_gradient;
  if (threads > 0) UseThreads(threads);
  const EstimatorNetwork& network = impl_->network;
  const SamplePlane& plane = set.plane;
  const Tensor known = torch::tensor(
      {{conditions.metals_rare ? 1.0f : 0.0f, conditions.light_calibrated ? 1.0f : 0.0f}});
  const auto forward = [&] {
    const auto [width, height] = SizeAtMost(plane.width, plane.height, kGlobalSize);
    const bool whole = width == plane.width && height == plane.height;
    const Shown small = ShownOf(whole ? set : Downsampled(set, width, height, threads), threads);
    if (whole) return network.Forward(small.features, small.profiles, known, torch::kFloat32);
    const auto global = network.Global(small.features, small.profiles, known, torch::kFloat32);
    return network.ForwardWithGlobal(ShownOf(set, threads).features, global, torch::kFloat32);
  };
  const EstimatorOutput out = forward();
  const EncodedMaps maps = CroppedMaps(out.maps.contiguous(), plane.width, plane.height);
  const EncodedMaps error =
      CroppedMaps(out.log_scale.exp().contiguous(), plane.width, plane.height);
  return {DecodeMaps(maps), DecodedDeviations(maps, error)};
}

}  // namespace glint

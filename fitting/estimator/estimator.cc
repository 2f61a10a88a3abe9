#include "fitting/estimator/estimator.h"

#include <algorithm>

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

}  // namespace

struct Estimator::Impl {
  LoadedEstimator loaded;
};

Estimator::Estimator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;
Estimator& Estimator::operator=(Estimator&&) noexcept = default;

Estimator Estimator::Load(const std::filesystem::path& weights) {
  Impl impl{LoadEstimator(weights)};
  impl.loaded.network.residual = !impl.loaded.single_photograph;
  return Estimator(std::make_unique<Impl>(std::move(impl)));
}

bool Estimator::single_photograph() const { return impl_->loaded.single_photograph; }

SvbrdfEstimate Estimator::Estimate(std::span<const Photograph> photographs,
                                   const SamplePlane& plane,
                                   const ReflectanceConvention& convention,
                                   const EstimatorConditions& conditions, int threads) const {
  torch::NoGradGuard no_gradient;
  if (threads > 0) UseThreads(threads);
  const auto count = static_cast<int64_t>(photographs.size());
  const int height = Padded(plane.height), width = Padded(plane.width);
  const Tensor features = torch::empty({1, count, kFeaturePlanes, height, width});
  const Tensor profiles = torch::empty({1, count, kProfileValues});
  for (int64_t i = 0; i < count; ++i) {
    const PhotographFeatures one =
        FeaturesOf(photographs[static_cast<size_t>(i)], plane, convention);
    CopyPadded(one, height, width, features[0][i].data_ptr<float>());
    std::copy(one.profile.begin(), one.profile.end(), profiles[0][i].data_ptr<float>());
  }
  const Tensor known = torch::tensor(
      {{conditions.metals_rare ? 1.0f : 0.0f, conditions.light_calibrated ? 1.0f : 0.0f}});
  const EstimatorOutput out =
      impl_->loaded.network.Forward(features, profiles, known, torch::kFloat32);
  return {DecodeMaps(CroppedMaps(out.maps.contiguous(), plane.width, plane.height)),
          CroppedMaps(out.log_scale.exp().contiguous(), plane.width, plane.height)};
}

}  // namespace glint

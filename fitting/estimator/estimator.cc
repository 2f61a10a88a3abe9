#include "fitting/estimator/estimator.h"

#include <algorithm>

#include "fitting/encoding/encoding_torch.h"
#include "fitting/estimator/estimator_file.h"
#include "fitting/estimator/photograph_features.h"

namespace glint {
namespace {

using torch::Tensor;

int Padded(int n) {
  return (n + kEstimatorDownsampling - 1) / kEstimatorDownsampling * kEstimatorDownsampling;
}

Tensor PaddedTensor(const PhotographFeatures& features) {
  const int height = Padded(features.height), width = Padded(features.width);
  const size_t texels = static_cast<size_t>(features.width) * features.height;
  Tensor padded = torch::empty({1, kFeaturePlanes, height, width});
  float* to = padded.data_ptr<float>();
  for (int p = 0; p < kFeaturePlanes; ++p) {
    for (int row = 0; row < height; ++row) {
      const float* from = features.planes.data() + p * texels +
                          static_cast<size_t>(std::min(row, features.height - 1)) * features.width;
      for (int column = 0; column < width; ++column) {
        *to++ = from[std::min(column, features.width - 1)];
      }
    }
  }
  return padded;
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

SvbrdfMaps Estimator::Estimate(const Photograph& photograph, const SamplePlane& plane,
                               const ReflectanceConvention& convention, int threads) const {
  torch::NoGradGuard no_gradient;
  if (threads > 0) torch::set_num_threads(threads);
  const PhotographFeatures features = FeaturesOf(photograph, plane, convention);
  Tensor profile = torch::empty({1, kProfileValues});
  std::copy(features.profile.begin(), features.profile.end(), profile.data_ptr<float>());
  const Tensor encoded =
      impl_->network.Forward(PaddedTensor(features), profile, torch::kFloat32).contiguous();
  return DecodeMaps(CroppedMaps(encoded, plane.width, plane.height));
}

}  // namespace glint

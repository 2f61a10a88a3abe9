// Maps from one flash photograph by a trained network: where fitting starts, and what there is when
// there is one photograph only. No torch in this header.
//
// Source of the role: Gao et al. 2019, section 4.3, who take Deschaintre et al. 2018's or Li et al.
// 2018's; the network is ours (estimator_network.h).
#pragma once

#include <filesystem>
#include <memory>

#include "fitting/photographs/photographs.h"
#include "fitting/reflectance/svbrdf_maps.h"

namespace glint {

class Estimator {
 public:
  // Reads weights written by glint-train. Throws std::runtime_error "FILE: PART: found …; MEND".
  static Estimator Load(const std::filesystem::path& weights);

  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  // Maps of the photograph's size, from 1×1; sizes that are not multiples of 32 are continued by
  // their last texel. Maps for diffuse weight 1. float32; the same bits for any `threads`.
  SvbrdfMaps Estimate(const Photograph& photograph, const SamplePlane& plane,
                      const ReflectanceConvention& convention, int threads) const;

 private:
  struct Impl;
  explicit Estimator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

// The photograph that an estimate should start from: the one seen from nearest the top whose mask
// covers almost as much as the best one's, and that is neither dark nor clipped.
size_t BestStartingPhotograph(const PhotographSet& set);

inline constexpr char kEstimatorModel[] = "estimator.safetensors";
// Trained on fewer metals: what is dark and glossy is taken for glass, lacquer or print.
inline constexpr char kRareMetalsEstimatorModel[] = "estimator_metals_rare.safetensors";

}  // namespace glint

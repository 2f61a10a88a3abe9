// Maps from flash photographs of a sample by a trained network, with their uncertainty: the
// initialisation of fitting. No torch in this header.
//
// Source of the role: Gao et al. 2019, section 4.3, who take Deschaintre et al. 2018's or Li et al.
// 2018's, of one photograph; the network, for any number, is ours (estimator_network.h).
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "base/reflectance/svbrdf_deviations.h"
#include "base/reflectance/svbrdf_maps.h"
#include "fitting/estimator/estimator_conditions.h"
#include "fitting/photographs/photographs.h"

namespace glint {

struct SvbrdfEstimate {
  SvbrdfMaps maps;
  SvbrdfDeviations deviations;  // of the maps, as the network expects them
};

class Estimator {
 public:
  // Texels along the longer side up to which training showed whole pictures. Of larger ones what is
  // global (a highlight's profile, means of features) is taken from the photographs at this size.
  static constexpr int kGlobalSize = 256;

  // Reads weights written by glint-train. Throws std::runtime_error "FILE: PART: found …; …".
  static Estimator Load(const std::filesystem::path& weights);

  ~Estimator();
  Estimator(Estimator&&) noexcept;
  Estimator& operator=(Estimator&&) noexcept;

  // Maps of the photographs' size, from 1×1; sizes that are not multiples of 32 are continued by
  // their last texel. Maps for diffuse weight 1. float32; the same bits for any `threads`, and for
  // any order of the photographs up to the rounding of their mean.
  SvbrdfEstimate Estimate(const PhotographSet& set, const EstimatorConditions& conditions,
                          int threads) const;

 private:
  struct Impl;
  explicit Estimator(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

inline constexpr char kEstimatorModel[] = "estimator.safetensors";

}  // namespace glint

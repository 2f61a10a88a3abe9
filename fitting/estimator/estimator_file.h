// The estimator's weights file. Include from .cc files only: this header pulls in torch.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "fitting/estimator/estimator_network.h"

namespace glint {

// Followed by the name of a network that is not the pooled one: "glint-estimator v3 descent".
inline constexpr char kEstimatorArchitecture[] = "glint-estimator v3";

// What a file of this network says of itself: architecture, encoding, channels (levels, full,
// global).
std::map<std::string, std::string> EstimatorMetadata(const EstimatorNetwork& network);

// Weights for users, in bf16 or float32.
void SaveEstimator(const std::filesystem::path& path, EstimatorNetwork* network,
                   std::map<std::string, std::string> metadata, bool bf16 = true);

// Throws std::runtime_error "FILE: PART: found …; what to do".
EstimatorNetwork LoadEstimator(const std::filesystem::path& path);

}  // namespace glint

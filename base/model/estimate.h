// How large the estimate of a sample is, and what cross-validation tries.
#pragma once

#include <array>
#include <cstddef>

#include "base/model/model_constant.h"

namespace glint::constants {

inline constexpr size_t kSampledTexels = 2048;
inline constexpr int kEstimationSize = 1024, kEstimationRounds = 16, kOtherSubstanceRounds = 4;
inline constexpr double kHalfVectorCell = 0.5;
inline constexpr size_t kLeastValidatedViews = 3;
inline constexpr int kMostFolds = 7;
inline constexpr int kBlockSide_texel = 4;
// In the order of SpreadKind: roughness, specular albedo, normals, diffuse albedo, the initial
// maps' errors, neighbours. Specular albedo's reaches further down than roughness's, with which it
// is scaled first and then alone. The initial maps were fitted to the photographs that are held
// out, so that their errors would be estimated too small.
inline constexpr std::array<int, 6> kLeastSdOctaves = {-2, -4, -2, -3, 0, -2};
inline constexpr std::array<int, 6> kMostSdOctaves = {2, 2, 2, 1, 4, 1};
inline constexpr double kInitialisationOctaves = 1;
inline constexpr double kImprobable = 3, kGivenUp = 12;
inline constexpr size_t kLeastViewsForOtherLobes = 5;
// Nearer to each other lobes are hard to tell apart: a step changes the prediction of held-out
// photographs of polished stone and bamboo by 1 to 5 %.
inline constexpr std::array<double, 4> kNarrowLobeShares = {0.3, 0.5, 0.7, 0.85};
inline constexpr std::array<double, 3> kNarrowLobeRatios = {0.6, 0.4, 0.25};
inline constexpr double kSecondLobeLogOdds = 3;
inline constexpr int kShortTail = 4;
inline constexpr double kShortTailLogOdds = 1;
inline constexpr std::array<double, 4> kRoughnessLevels = {0.25, 0.35, 0.5, 0.7};
inline constexpr double kRoughnessLevelSd = 0.1;
inline constexpr double kRoughNormalSd = 0.1, kRoughnessLogOdds = 1;
inline constexpr double kAnisotropyStep = 0.2;
inline constexpr double kAnisotropyLogOdds = 5;
inline constexpr int kPowerReach_octaves = 3;
inline constexpr double kPowerStep_octaves = 1;

inline constexpr ModelConstant kEstimateRows[] = {
    Row("kSampledTexels", {kSampledTexels}, "texels",
        "from which the sample as a whole is estimated",
        "real held-out log-L1 with 512, 1024, 2048: 0.2586, 0.2566, 0.2538"),
    Row("kEstimationSize", {kEstimationSize}, "texels",
        "longer side of the grid from which they are drawn", "up to it all texels can be sampled",
        "--estimation-size"),
    Row("kEstimationRounds, kOtherSubstanceRounds", {kEstimationRounds, kOtherSubstanceRounds},
        "rounds", "of the estimate, and of the means of other substances",
        "8 leave exposures of a synthetic capture 3 % off, 20 leave 1 %", "--estimation-rounds"),
    Row("kHalfVectorCell", {kHalfVectorCell}, "τ",
        "side of the cells by which half vectors count as different", "half a length scale"),
    Row("kLeastValidatedViews, kMostFolds", {kLeastValidatedViews, kMostFolds},
        "photographs; folds", "of cross-validation",
        "of two, one would have to predict the other; 4 folds: 0.2558"),
    Row("kBlockSide_texel", {kBlockSide_texel}, "texels",
        "blocks of texels that are each other's neighbours in it",
        "what is best for single texels is too narrow for texels with neighbours"),
    Row("kLeastSdOctaves", {kLeastSdOctaves}, "log₂",
        "least factors on the standard deviations θ (roughness, specular albedo, normals, diffuse "
        "albedo, initial maps' errors, neighbours)",
        "specular albedo's reaches further: it is scaled with roughness's first, then alone"),
    Row("kMostSdOctaves", {kMostSdOctaves}, "log₂", "largest factors",
        "normals × 2 leave a foam's pores too flat, × 8 are no better"),
    Row("kInitialisationOctaves", {kInitialisationOctaves}, "log₂",
        "prior standard deviation of the factor on the initial maps' errors",
        "1, 1.5 and 2 compared"),
    Row("kImprobable", {kImprobable}, "log probability", "below the best, where an axis ends",
        "e⁻³: less than 5 % is left out"),
    Row("kGivenUp", {kGivenUp}, "log probability",
        "below the best by every other fold, where spreads are not tried further",
        "with 3 a dark dielectric's specular albedo errs by .016, with 6, 12, 24 and without by "
        ".0135; with 12 searches end a tenth sooner"),
    Row("kNarrowLobeShares", {kNarrowLobeShares}, "share", "of the narrow lobe",
        "a step changes held-out errors by 1 to 5 %"),
    Row("kNarrowLobeRatios", {kNarrowLobeRatios}, "ratio of roughnesses", "of the narrow lobe",
        "the same"),
    Row("kSecondLobeLogOdds, kLeastViewsForOtherLobes",
        {kSecondLobeLogOdds, kLeastViewsForOtherLobes}, "log odds; photographs",
        "against a second lobe; the least for one, other shapes and one roughness",
        "three of fourteen real samples have one; of four synthetic photographs it was found by "
        "mistake"),
    Row("kShortTail", {kShortTail}, "γ", "of lobes' tails, tried beside GGX's 2",
        "held-out errors with 3 and 5 are within 5 % of those with 4, none gains with 8"),
    Row("kShortTailLogOdds", {kShortTailLogOdds}, "log odds", "against short tails",
        "eight of fourteen real samples have them"),
    Row("kRoughnessLevels", {kRoughnessLevels}, "1", "of all substances alike",
        "half octaves; below them means are found well, real plaster and foam ask for the highest"),
    Row("kRoughnessLevelSd", {kRoughnessLevelSd}, "relative", "that these leave open",
        "ln 2/2 over √12"),
    Row("kRoughNormalSd", {kRoughNormalSd}, "1", "θ_n beside such a roughness, until it is scaled",
        "0.05, 0.1, 0.2: leather with 02 and 06 held out .45, .44, .44, with 01 and 05 .48, .41, "
        ".41"),
    Row("kRoughnessLogOdds", {kRoughnessLogOdds}, "log odds", "against such a roughness",
        "it is the best of four; 15 of 42 real fits ask for it"),
    Row("kAnisotropyStep", {kAnisotropyStep}, "ln α", "of the search for anisotropic lobes",
        "a walnut held out: .274, .266, .263 and .261 with ratios 1.16, 1.22, 1.25 and 1.45"),
    Row("kAnisotropyLogOdds", {kAnisotropyLogOdds}, "log odds", "against anisotropic lobes",
        "real woods and a gift bag reach 6 to 84; of 18 other fits the most is 4.4, a plaster's, "
        "which would lose a quarter"),
    Row("kPowerReach_octaves, kPowerStep_octaves", {kPowerReach_octaves, kPowerStep_octaves},
        "octaves", "of the light's power that fit tries, each way; then half a step", "⅛ to 8"),
};

}  // namespace glint::constants

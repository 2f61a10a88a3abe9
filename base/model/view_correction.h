// Errors of single views: what is expected of them, and what gain a correction must bring.
#pragma once

#include <cstddef>

#include "base/model/model_constant.h"

namespace glint::constants {

inline constexpr double kLeastDistinctViews = 5;
inline constexpr double kLeastGain = 0.02, kLeastViewsGain = 0.05, kLeastRegistrationGain = 0.1;
inline constexpr int kCorrectionRounds = 3, kCorrectionSize_texel = 256;
inline constexpr double kCorrectedLightSd = 0.03, kCorrectedDistanceSd = 0.03;
inline constexpr double kSharedLightSd = 0.3;
inline constexpr double kCorrectedLevelSd = 0.01;
inline constexpr int kEnvironmentDegree = 8;
inline constexpr double kAmbientSd = 0.1, kAmbientDirectionSd = 0.02;
inline constexpr double kCorrectedExposureSd = 0.1;
inline constexpr double kShiftSd_texel = 1.0, kSharedShiftSd_texel = 1e-3;
inline constexpr double kEffectiveResiduals = 20, kIndependentResiduals = 200;
inline constexpr double kLooksLikeNoise = 1.5;
inline constexpr int kCorrectionTexels = 1024, kLastCorrectionTexels = 2304;
inline constexpr double kViewsOfAllTexels = 40;
inline constexpr int kFewestCorrectionTexels = 256;
inline constexpr double kCorrectionNormalSd = 1;
inline constexpr double kFirstCorrectionSigma = 0.02, kLeastCorrectionSigma = 0.005;
inline constexpr double kRoundingSigma = 0.007;
// A mean square over so many is known to a tenth. A prime: the sampled texels stand in columns.
inline constexpr size_t kPropagatedTexels = 281;

inline constexpr ModelConstant kViewCorrectionRows[] = {
    Row("kLeastDistinctViews", {kLeastDistinctViews}, "views",
        "from which on corrections are looked for",
        "with five photographs corrections were bought by texels in wrong minima"),
    Row("kLeastGain, kLeastViewsGain, kLeastRegistrationGain",
        {kLeastGain, kLeastViewsGain, kLeastRegistrationGain}, "of the cost",
        "gains required: of a correction, of lights beyond ambient illumination, of displacements "
        "beyond what interpolation smooths",
        "correct views gain at most 0.2 %; a city's light 0 to 2 %, lights off by 1° 35 to 88 %"),
    Row("kCorrectionRounds, kCorrectionSize_texel", {kCorrectionRounds, kCorrectionSize_texel},
        "rounds; texels", "of correcting and refining in turn, and the longer side at which",
        "0.84° left after one round, 0.04° after three"),
    Row("kCorrectedLightSd, kCorrectedDistanceSd", {kCorrectedLightSd, kCorrectedDistanceSd},
        "distances", "A: of a light's own offset, across its direction and along",
        "calibration's `light_sd_mm` where it is stated"),
    Row("kSharedLightSd", {kSharedLightSd}, "distances",
        "Ā: of the offset that all lights share, across; along as above",
        "lights that are off together and tilted normals explain the same"),
    Row("kCorrectedLevelSd", {kCorrectedLevelSd}, "slope", "s_l: of the sample's mean slope",
        "the same"),
    Row("kAmbientSd, kAmbientDirectionSd", {kAmbientSd, kAmbientDirectionSd}, "flash at the centre",
        "s_b, s_j: of ambient illumination's mean, and of each term of its direction",
        "0.3, and 0.1 for directions, are worse"),
    Row("kEnvironmentDegree", {kEnvironmentDegree}, "degree",
        "of the spherical harmonics of ambient illumination",
        "2 is worse on two of three materials, 12 takes twice the time"),
    Row("kCorrectedExposureSd", {kCorrectedExposureSd}, "log",
        "s_η: of exposures, with `--correct-exposures`", "a choice"),
    Row("kShiftSd_texel, kSharedShiftSd_texel", {kShiftSd_texel, kSharedShiftSd_texel}, "texels",
        "s_u, s_ū: of the displacement of a picture's corners, and of its mean over views",
        "left free, the mean drifted by half a texel"),
    Row("kEffectiveResiduals, kIndependentResiduals", {kEffectiveResiduals, kIndependentResiduals},
        "residuals",
        "N: effective sample size of a view, where channels' residuals are correlated and where "
        "not",
        "1,000 moves correct lights by 2.5°, always 20 leaves 0.1° to 0.3°"),
    Row("kLooksLikeNoise", {kLooksLikeNoise}, "channel factor", "below which they are not",
        "rounding gives 1 to 1.13, errors of views 1.8 to 3"),
    Row("kCorrectionTexels, kLastCorrectionTexels", {kCorrectionTexels, kLastCorrectionTexels},
        "texels", "sampled, about, and for the last descent", "a choice"),
    Row("kViewsOfAllTexels, kFewestCorrectionTexels", {kViewsOfAllTexels, kFewestCorrectionTexels},
        "views; texels", "beyond which fewer texels are sampled, by the square, and the fewest",
        "a texel's work grows with the square of the views"),
    Row("kCorrectionNormalSd", {kCorrectionNormalSd}, "", "of n_x and n_y about the initial maps",
        "normals fitted under wrong lights must be free to tilt back"),
    Row("kFirstCorrectionSigma, kLeastCorrectionSigma",
        {kFirstCorrectionSigma, kLeastCorrectionSigma}, "log radiance",
        "σ of the first descent, and the least thereafter", "a choice"),
    Row("kRoundingSigma", {kRoundingSigma}, "log radiance",
        "added to the cost that gains are compared with", "rounding to 8 bits"),
    Row("kPropagatedTexels", {kPropagatedTexels}, "texels",
        "over which the views' covariance is propagated", "a mean square known to a tenth"),
};

}  // namespace glint::constants

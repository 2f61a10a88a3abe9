// Priors of the light of captures that were not calibrated, and of lamps that move.
#pragma once

#include "base/model/model_constant.h"

namespace glint::constants {

inline constexpr double kFlashOffsetSd = 0.05;
inline constexpr double kFlashBeamSd = 0.3;
inline constexpr double kDistancePowerSd = 1;
inline constexpr double kToeSd = 0.02, kShoulderSd = 0.2;
inline constexpr double kExposureSd = 0.1, kLightPlaceSd = 0.02;
inline constexpr double kViewSdWeight = 2;
inline constexpr double kMeanDeviationPrecision = 1e3;
inline constexpr double kLampGradientSd = 0.5, kLampLevelSd = 0.02;
inline constexpr int kHeldOutSide_texel = 128;

inline constexpr ModelConstant kLightRows[] = {
    Row("kFlashOffsetSd", {kFlashOffsetSd}, "distances", "Ω of the flash's offset",
        "highlights of fourteen real samples are 2 to 11 % off", "--flash-offset"),
    Row("kFlashBeamSd", {kFlashBeamSd}, "log per tangent", "Ω of the gradient of the flash's beam",
        "a fall-off to a half at 33° has it for an axis 10° beside the sample", "--flash-beam"),
    Row("kDistancePowerSd", {kDistancePowerSd}, "exponent", "Ω of the power of distance",
        "2 is an exposure that makes up for all of it", "--distance-power"),
    Row("kToeSd", {kToeSd}, "radiance",
        "Ω of the toe of the photographs' curve; of known light, too",
        "sRGB's curve read by gamma 2.2 has one of 0.007 and a shoulder of 0.06 (to 0.3 %); "
        "cameras' contrast curves have several times that",
        "--toe"),
    Row("kShoulderSd", {kShoulderSd}, "1", "Ω of its shoulder", "likewise", "--shoulder"),
    Row("kExposureSd", {kExposureSd}, "log",
        "Φ₀ of single exposures; and of a view's shading from the centre to the edge",
        "then estimated: 4 to 26 % of fourteen real samples", "--exposure-spread"),
    Row("kLightPlaceSd", {kLightPlaceSd}, "distances",
        "Φ₀ of single views' lights across their direction", "then estimated: 1.4 to 1.6 %",
        "--light-spread"),
    Row("kViewSdWeight, kMeanDeviationPrecision", {kViewSdWeight, kMeanDeviationPrecision},
        "views; factor",
        "what Φ₀ is worth in estimating Φ, and the precision of the views' sum by a view's "
        "own",
        "the mean is the albedos' and the flash's offset"),
    Row("kLampGradientSd", {kLampGradientSd}, "log",
        "λ: of the gradient of lamps' strengths over directions; fixed camera",
        "a dome half as bright on one side", "--lamp-gradient"),
    Row("kLampLevelSd", {kLampLevelSd}, "slope", "of the sample's mean slope; fixed camera",
        "a degree", "--level-spread"),
    Row("kHeldOutSide_texel", {kHeldOutSide_texel}, "texels",
        "longer side of the grid from which a held-out lamp's strength is read",
        "16,384 texels pin a median to a thousandth"),
};

}  // namespace glint::constants

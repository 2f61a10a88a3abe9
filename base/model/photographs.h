// What photographs are compared by: the logarithm, the loss, noise, discrepancy and blur.
#pragma once

#include "base/model/model_constant.h"

namespace glint::constants {

inline constexpr double kLogOffset = 0.01;
inline constexpr double kRobustScale = 0.1;
inline constexpr double kClippedRadiance = 0.99;
inline constexpr double kCodeGamma = 2.2;
inline constexpr double kSensorNoise = 0.003;
inline constexpr double kDiscrepancyLength_deg = 8;
inline constexpr double kSmoothShare = 0.8;
inline constexpr double kChannelCorrelation = 0.9;
inline constexpr double kResidualSigma = 0.05, kUncalibratedResidualSigma = 0.1;
inline constexpr double kResidualSigmaWeight = 1;
inline constexpr double kPointSpread_px = 0.67, kResamplingSpread_px = 0.33;
inline constexpr double kLeastHiddenDetail = 0.01, kLeastRelativeBlur = 0.15;
inline constexpr int kDeblurSteps = 2;
inline constexpr double kPriorWeight = 1;
inline constexpr double kTexelVariance = 0.0915, kMostBlurVariance = 8;

inline constexpr ModelConstant kPhotographRows[] = {
    Row("kLogOffset", {kLogOffset}, "radiance", "ε: added before the logarithm is taken",
        "Gao et al. 2019, eq. 2"),
    Row("kRobustScale", {kRobustScale}, "log radiance",
        "δ: the loss is quadratic up to it, linear beyond",
        "DIR's loss is linear throughout; 0.2 changes real held-out errors by 0.3 %",
        "--robust-scale"),
    Row("kClippedRadiance", {kClippedRadiance}, "radiance",
        "a photograph that clips is censored from it on", "8-bit rounding after resampling"),
    Row("kCodeGamma", {kCodeGamma}, "", "gamma of 8-bit codes, for the noise of rounding",
        "files are taken as gamma 2.2 unless stated"),
    Row("kSensorNoise", {kSensorNoise}, "relative",
        "standard deviation of sensor noise after resampling",
        "a choice; without it renderings from twenty clean views have 9 % more error"),
    Row("kDiscrepancyLength_deg", {kDiscrepancyLength_deg}, "degrees",
        "τ: half vectors over which discrepancy stays alike",
        "as in version 10; not measured again"),
    Row("kSmoothShare", {kSmoothShare}, "",
        "a: share of discrepancy that is smooth in the half vector",
        "the rest is registration and exposure, each view's own"),
    Row("kChannelCorrelation", {kChannelCorrelation}, "",
        "κ: inter-channel correlation of discrepancy", "fourteen real samples: 0.75 to 0.99"),
    Row("kResidualSigma, kUncalibratedResidualSigma", {kResidualSigma, kUncalibratedResidualSigma},
        "log radiance", "σ₀: prior mean of σ, with calibrated light and without",
        "decides for one and two photographs; 0.1 is the mean of fourteen real samples (0.045 to "
        "0.17)",
        "--residual-sigma"),
    Row("kResidualSigmaWeight", {kResidualSigmaWeight}, "residuals per texel",
        "w₀: what that prior is worth while views are estimated",
        "without it five photographs are too sure"),
    Row("kPointSpread_px", {kPointSpread_px}, "pixels",
        "standard deviation of a photograph's blur where calibration did not measure it",
        "responses of kernel and pixel area at half a cycle (0.58, 0.64), a lens of 0.5; 0.66 on "
        "synthetic photographs",
        "--point-spread"),
    Row("kResamplingSpread_px", {kResamplingSpread_px}, "pixels",
        "that of resampling, beside a blur that was measured", "its kernel's response, as above"),
    Row("kLeastHiddenDetail", {kLeastHiddenDetail}, "log radiance",
        "RMS of the detail that a photograph's blur hides and sharper ones show, from which on "
        "they lend it theirs",
        "rounding to 8 bits is 0.007"),
    Row("kLeastRelativeBlur", {kLeastRelativeBlur}, "texels²",
        "by which a photograph must be blurred more than the sharper half",
        "distances of handheld photographs make 0.1 of a phone's blur"),
    Row("kDeblurSteps", {kDeblurSteps}, "steps", "of taking a photograph's blur off, in each pass",
        "leather of 1.3 pixels' blur, two pixels to a texel: normals 2.8, 2.0, 1.9, 2.0° off with "
        "1, 2, 3, 6; sharp, a pixel to a texel: 1.63, 1.70, 1.80, 2.00°"),
    Row("kTexelVariance, kMostBlurVariance", {kTexelVariance, kMostBlurVariance}, "texels²",
        "taken off the blur's variance as a texel's own area, and most of what is left",
        "response sinc(½) at half a cycle; bounds how many rows depend on each other"),
    Row("kPriorWeight", {kPriorWeight}, "factor", "on the precision of all of a texel's priors",
        "Bayes' rule", "--prior"),
};

}  // namespace glint::constants

// Every number of the statistical model (docs/model.md) that can change a map: its value, its unit
// and where it comes from. The tables of docs/model.md are made from the rows below, which name the
// constants themselves; tests/base/model compares them, and GLINT_UPDATE=1 ctest -R model_page
// writes them anew.
//
// Defaults of options are these constants. Not here: the reflectance model (docs/conventions.md),
// what makes the initial maps, and sizes of memory and work that change no value.
//
// "Longer side" is the sample's; log radiance is log(radiance + kLogOffset).
#pragma once

#include <array>
#include <cstddef>

namespace glint::constants {

// The numbers of one row, as they are compiled in.
struct ConstantValues {
  template <class... T>
  constexpr ConstantValues(T... values)  // NOLINT: rows are lists of values
      : of{static_cast<double>(values)...}, count(sizeof...(T)) {}
  template <class T, size_t N>
  constexpr ConstantValues(const std::array<T, N>& values) : count(N) {  // NOLINT
    for (size_t i = 0; i < N; ++i) of[i] = static_cast<double>(values[i]);
  }
  std::array<double, 8> of{};
  size_t count = 0;
};

struct ModelConstant {
  const char* name;  // in the code; of a row of several, separated by commas
  ConstantValues values;
  const char* unit;     // "": a number
  const char* meaning;  // Markdown, as the next
  const char* source;
  const char* option;  // whose default it is; "": none
};

constexpr ModelConstant Row(const char* name, const ConstantValues& values, const char* unit,
                            const char* meaning, const char* source = "", const char* option = "") {
  return {name, values, unit, meaning, source, option};
}

// --- The photographs -----------------------------------------------------------------------------

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
inline constexpr double kPointSpread_px = 0.67;
inline constexpr double kPriorWeight = 1;
inline constexpr double kTexelVariance = 0.0915, kMostBlurVariance = 2;

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
    Row("kPointSpread_px", {kPointSpread_px}, "pixels", "standard deviation of a photograph's blur",
        "responses of kernel and pixel area at half a cycle (0.58, 0.64), a lens of 0.5; 0.66 on "
        "synthetic photographs; phones not measured",
        "--point-spread"),
    Row("kTexelVariance, kMostBlurVariance", {kTexelVariance, kMostBlurVariance}, "texels²",
        "taken off the blur's variance as a texel's own area, and most of what is left",
        "response sinc(½) at half a cycle; bounds how many rows depend on each other"),
    Row("kPriorWeight", {kPriorWeight}, "factor", "on the precision of all of a texel's priors",
        "Bayes' rule", "--prior"),
};

// --- Initial maps --------------------------------------------------------------------------------

inline constexpr double kInitialNormalSd = 0.10, kInitialRoughnessSd = 0.10;
inline constexpr double kInitialDiffuseSd = 0.03, kInitialDiffuseRelativeSd = 0.1;
inline constexpr double kInitialSpecularSd = 0.02, kInitialSpecularRelativeSd = 0.2;
inline constexpr double kSeenAlready = 3;

inline constexpr ModelConstant kInitialMapsRows[] = {
    Row("kInitialNormalSd, kInitialRoughnessSd", {kInitialNormalSd, kInitialRoughnessSd}, "",
        "errors of n_x and n_y, and of roughness, where none are stated",
        "RMS of forty materials' latent fits: 0.10 to 0.14, 0.11 to 0.12"),
    Row("kInitialDiffuseSd, kInitialDiffuseRelativeSd",
        {kInitialDiffuseSd, kInitialDiffuseRelativeSd}, "albedo; relative",
        "errors of diffuse albedo, likewise: the sum of both", "the same fits: 0.03 to 0.06"),
    Row("kInitialSpecularSd, kInitialSpecularRelativeSd",
        {kInitialSpecularSd, kInitialSpecularRelativeSd}, "albedo; relative",
        "errors of specular albedo, likewise", "the same fits: 0.07 to 0.10"),
    Row("kSeenAlready", {kSeenAlready}, "factor",
        "on the albedos' errors from three photographs on; roughness and normals are not taken",
        "the initial maps were fitted to the same photographs; 1, 3, 10 compared"),
};

// --- Substances ----------------------------------------------------------------------------------

inline constexpr int kSubstances = 8;
// Chroma tells substances apart better than brightness, which shading changes too.
inline constexpr float kBrightnessWeight = 0.5f, kChromaWeight = 2.0f, kGlossWeight = 2.0f;
inline constexpr float kColourOffset = 0.01f;
inline constexpr float kMembershipWidth = 0.2f;
inline constexpr float kLeastShare = 1e-3f;
inline constexpr int kLookCells = 16;
inline constexpr size_t kLeastGlossViews = 3;
inline constexpr double kLeastGlossInformation = 1e-3, kSteepestGloss = 3;
inline constexpr double kGlossLogOdds = 3;
inline constexpr float kLeastIncidence = 0.05f;
inline constexpr double kDielectricF0 = 0.04, kDielectricLogSd = 0.35;
inline constexpr double kDielectricColouredShare = 0.05;
inline constexpr double kMetalF0 = 0.5, kMetalLogSd = 0.5, kMetalColouredShare = 0.5;
inline constexpr double kRareMetalShare = 0.1, kPossibleMetalShare = 0.5;
inline constexpr double kGreyChromaSd = 0.05, kColouredChromaSd = 0.6;
inline constexpr double kSpecularOffset = 0.02, kBlackSpecular = 0.001;
inline constexpr double kLightPowerSd = 0.1, kUncalibratedLightPowerSd = 0.5;
inline constexpr double kMostDiffuse = 0.9;
inline constexpr double kRoughnessSd = 0.1, kSpecularSd = 0.8, kDiffuseSd = 1.0;
inline constexpr double kBetweenToWithin = 2;
inline constexpr double kNormalSd = 0.05, kNormalSdTexels = 20;
inline constexpr double kNeighbourSd = 1;

inline constexpr ModelConstant kSubstanceRows[] = {
    Row("kSubstances", {kSubstances}, "", "most substances",
        "6 is 1 % worse on real held-out views", "--substances"),
    Row("kBrightnessWeight, kChromaWeight, kGlossWeight",
        {kBrightnessWeight, kChromaWeight, kGlossWeight}, "per log unit",
        "of the features that k-means compares",
        "shading changes brightness too; gloss × 0, 0.6, 1, 2, 3 compared"),
    Row("kColourOffset", {kColourOffset}, "albedo",
        "added to the median colour before its logarithm", "as kLogOffset"),
    Row("kMembershipWidth", {kMembershipWidth}, "features", "width of soft membership", "a choice"),
    Row("kLeastShare", {kLeastShare}, "", "a texel with less of a substance has nothing of it",
        "saves work"),
    Row("kLeastIncidence", {kLeastIncidence}, "cosine",
        "least that irradiance is multiplied by, for the colour of the median photograph",
        "grazing light would make noise a colour"),
    Row("kLookCells", {kLookCells}, "per side",
        "cells of the sample in which a photograph's median is taken",
        "as fine as highlights, far coarser than texture"),
    Row("kLeastGlossViews, kLeastGlossInformation, kSteepestGloss",
        {kLeastGlossViews, kLeastGlossInformation, kSteepestGloss}, "views; log²; slope",
        "least that a slope of gloss is taken from, and the steepest",
        "a line through two points has no error"),
    Row("kGlossLogOdds", {kGlossLogOdds}, "log odds",
        "of substances by gloss against those by colour alone", "dividing in vain loses little"),
    Row("kDielectricF0, kDielectricLogSd, kDielectricColouredShare",
        {kDielectricF0, kDielectricLogSd, kDielectricColouredShare}, "F0; log; share",
        "dielectrics: median, standard deviation of the logarithm, share with coloured highlights",
        "indices of refraction 1.33 to 1.8; 5 %: as in wood, whose F0 is drawn up without"),
    Row("kMetalF0, kMetalLogSd, kMetalColouredShare", {kMetalF0, kMetalLogSd, kMetalColouredShare},
        "F0; log; share", "metals, likewise", "pure and tarnished metals reflect a third to all"),
    Row("kRareMetalShare, kPossibleMetalShare", {kRareMetalShare, kPossibleMetalShare}, "share",
        "of substances that are metals, by `[fit] metals`", "a choice"),
    Row("kGreyChromaSd, kColouredChromaSd", {kGreyChromaSd, kColouredChromaSd}, "relative",
        "departure of channels from their mean, of highlights without and with a colour",
        "a choice"),
    Row("kSpecularOffset, kBlackSpecular", {kSpecularOffset, kBlackSpecular}, "albedo",
        "ε_k: added where departures are relative; and before the logarithm of F0",
        "half of what dielectrics reflect at least; black to all photographs"),
    Row("kLightPowerSd, kUncalibratedLightPowerSd", {kLightPowerSd, kUncalibratedLightPowerSd},
        "log", "s_g: standard deviation of the light's power, calibrated and not",
        "a board's white is known within a tenth, an estimated power within a half",
        "--light-power-spread"),
    Row("kMostDiffuse", {kMostDiffuse}, "albedo",
        "that the lightest substance may have under the power that is found",
        "white paint and paper"),
    Row("kRoughnessSd, kSpecularSd, kDiffuseSd", {kRoughnessSd, kSpecularSd, kDiffuseSd},
        "1; relative; relative",
        "θ_r, θ_k, θ_d of texels about their substance, before cross-validation",
        "then × the factors below; diffuse unknown (∞) until cross-validation begins"),
    Row("kBetweenToWithin", {kBetweenToWithin}, "factor",
        "on them, for substances about their common mean", "a wide hyper-prior"),
    Row("kNormalSd, kNormalSdTexels", {kNormalSd, kNormalSdTexels}, "1; texels",
        "θ_n of n_x and n_y about 0, and what that is worth in estimating it by substance",
        "the RMS of the initial maps predicts worse"),
    Row("kNeighbourSd", {kNeighbourSd}, "factor", "θ_b before cross-validation", "a choice"),
};

// --- The estimate and cross-validation -----------------------------------------------------------

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
inline constexpr std::array<int, 6> kMostSdOctaves = {2, 2, 1, 1, 4, 1};
inline constexpr double kInitialisationOctaves = 1;
inline constexpr double kImprobable = 3;
inline constexpr size_t kLeastViewsForTwoLobes = 5;
// Nearer to each other lobes are hard to tell apart: a step changes the prediction of held-out
// photographs of polished stone and bamboo by 1 to 5 %.
inline constexpr std::array<double, 4> kNarrowLobeShares = {0.3, 0.5, 0.7, 0.85};
inline constexpr std::array<double, 3> kNarrowLobeRatios = {0.6, 0.4, 0.25};
inline constexpr double kSecondLobeLogOdds = 3;
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
        "normals × 4 let tiles' joints bend the tiles"),
    Row("kInitialisationOctaves", {kInitialisationOctaves}, "log₂",
        "prior standard deviation of the factor on the initial maps' errors",
        "1, 1.5 and 2 compared"),
    Row("kImprobable", {kImprobable}, "log probability", "below the best, where an axis ends",
        "e⁻³: less than 5 % is left out"),
    Row("kNarrowLobeShares", {kNarrowLobeShares}, "share", "of the narrow lobe",
        "a step changes held-out errors by 1 to 5 %"),
    Row("kNarrowLobeRatios", {kNarrowLobeRatios}, "ratio of roughnesses", "of the narrow lobe",
        "the same"),
    Row("kSecondLobeLogOdds, kLeastViewsForTwoLobes", {kSecondLobeLogOdds, kLeastViewsForTwoLobes},
        "log odds; photographs", "against a second lobe, and the least for one",
        "three of fourteen real samples have one; of four synthetic photographs it was found by "
        "mistake"),
    Row("kPowerReach_octaves, kPowerStep_octaves", {kPowerReach_octaves, kPowerStep_octaves},
        "octaves", "of the light's power that fit tries, each way; then half a step", "⅛ to 8"),
};

// --- The light of captures that were not calibrated ----------------------------------------------

inline constexpr double kFlashOffsetSd = 0.05;
inline constexpr double kFlashBeamSd = 0.3;
inline constexpr double kDistancePowerSd = 1;
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

// --- View correction -----------------------------------------------------------------------------

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

// --- Registration --------------------------------------------------------------------------------

inline constexpr double kSampleHeightSd_mm = 10;
inline constexpr double kMeasuredHeightShare = 0.1, kMeasuredHeightSd_mm = 0.5;
inline constexpr double kFittedPlaneSd = 0.005, kImportedHeightSd = 0.02;
inline constexpr double kPlaneSlopeSd = 0.02;
inline constexpr double kCalibratedPlaceSd = 2e-4, kImportedPlaceSd = 0.004;
inline constexpr double kHomographySdViews = 2;
inline constexpr int kMostFactors = 3;
inline constexpr double kLeastTextureNoise = 0.003, kLeastTexture = 1e-4;
inline constexpr double kTellingLogLikelihood = 10;
inline constexpr double kPixelsPerSample = 8;
inline constexpr double kTextureWindow = 1.0 / 8, kTextureRim = 1.0 / 32;
inline constexpr int kRegistrationSide_px = 512;
inline constexpr double kCoarseDetail = 1.0 / 64, kFineDetail = 3.0 / 512;
inline constexpr double kLeastHeightSd = 5e-5, kCommonHeightSd = 3e-4, kCommonScatter = 1;
inline constexpr double kCommonShiftSd = 3e-4;
// Windows overlap by half along both axes.
inline constexpr double kTimesCounted = 4;
inline constexpr double kNeedsPairs = 1.0 / 512;
inline constexpr std::array<double, 4> kPairWindows = {1.0 / 4, 1.0 / 4, 3.0 / 16, 1.0 / 8};
inline constexpr double kPairsHeightSd = 0.005;
inline constexpr double kLongestShift = 0.02;
inline constexpr double kLeastResponse = 0.08;
inline constexpr double kFirstShiftSd_px = 0.5, kLeastShiftSd_px = 0.05;
inline constexpr double kLargestImportMargin = 1.2;

inline constexpr ModelConstant kRegistrationRows[] = {
    Row("kSampleHeightSd_mm", {kSampleHeightSd_mm}, "mm",
        "s_h: of the plane's height, in a board's window or under its frame",
        "samples up to some 25 mm high"),
    Row("kMeasuredHeightShare, kMeasuredHeightSd_mm", {kMeasuredHeightShare, kMeasuredHeightSd_mm},
        "relative; mm", "s_h of a measured height: the larger", "measured by hand"),
    Row("kFittedPlaneSd, kImportedHeightSd", {kFittedPlaneSd, kImportedHeightSd}, "longer side",
        "s_h of a plane through COLMAP's points, and of imported sets",
        "published sets lie up to 1.4 % off"),
    Row("kPlaneSlopeSd", {kPlaneSlopeSd}, "slope", "s_p: of the plane", "a degree"),
    Row("kCalibratedPlaceSd, kImportedPlaceSd", {kCalibratedPlaceSd, kImportedPlaceSd},
        "longer side", "prior s_H of homographies, with calibrated poses and imported",
        "0.2 texels of 1024; published photographs are up to 0.5 % out of place"),
    Row("kHomographySdViews", {kHomographySdViews}, "views",
        "what that is worth in estimating s_H by kind", "a weak prior"),
    Row("kMostFactors", {kMostFactors}, "", "of factor analysis", "albedo and two slopes"),
    Row("kLeastTextureNoise, kLeastTexture", {kLeastTextureNoise, kLeastTexture},
        "of a view's variance; of the largest", "least of Ψ, and least that counts as texture",
        "JPEG and resampling"),
    Row("kTellingLogLikelihood", {kTellingLogLikelihood}, "log likelihood",
        "gain over the other heights, least of a window that is used",
        "more than noise makes of itself"),
    Row("kPixelsPerSample", {kPixelsPerSample}, "pixels²",
        "that one independent value of texture covers", "texture as fine as what is compared"),
    Row("kTextureWindow, kTextureRim", {kTextureWindow, kTextureRim}, "longer side",
        "side of a window, and the rim that is left out", "64 and 16 pixels of 512"),
    Row("kRegistrationSide_px", {kRegistrationSide_px}, "pixels",
        "longer side of the pictures compared", "more tells no more"),
    Row("kCoarseDetail, kFineDetail", {kCoarseDetail, kFineDetail}, "longer side",
        "scale of the high-pass, of pairs and of what all views have in common",
        "coarser structure is shading and highlights"),
    Row("kLeastHeightSd, kCommonHeightSd, kCommonScatter",
        {kLeastHeightSd, kCommonHeightSd, kCommonScatter}, "longer side; longer side; factor",
        "of windows' heights: least; what all have wrong together; and that by their scatter",
        "synthetic leather, wood and metal are up to 0.0007 off, grass by 1.6 scatters"),
    Row("kCommonShiftSd", {kCommonShiftSd}, "half longer sides",
        "what seems a displacement of photographs in place",
        "0.15 texels of 1024; synthetic captures seem displaced by 0.0002"),
    Row("kTimesCounted", {kTimesCounted}, "", "how often overlapping windows count a place",
        "they overlap by half along both axes"),
    Row("kNeedsPairs", {kNeedsPairs}, "longer side",
        "prior s_H from which on pairs are compared first",
        "a pixel of 512: as far as what views have in common reaches"),
    Row("kPairWindows", {kPairWindows}, "longer side",
        "windows of the pairs' rounds: plane, translations, affine, homographies",
        "small windows need photographs nearly in place"),
    Row("kPairsHeightSd", {kPairsHeightSd}, "longer side", "of a plane by pairs alone, for shading",
        "synthetic leather seems to lie so much too low"),
    Row("kLongestShift, kLeastResponse", {kLongestShift, kLeastResponse}, "longer side; share",
        "of a pair's displacement: longest, and least share of energy in the peak",
        "10 pixels of 512"),
    Row("kFirstShiftSd_px, kLeastShiftSd_px", {kFirstShiftSd_px, kLeastShiftSd_px}, "pixels",
        "of a pair's displacement: at first, and least", "phase correlation's own"),
    Row("kLargestImportMargin", {kLargestImportMargin}, "factor",
        "of the sample's size that imported pictures are used to",
        "the sample may lie higher than assumed"),
};

// --- The solver ----------------------------------------------------------------------------------

inline constexpr int kSolveIterations = 40;
inline constexpr int kStarts = 2;
inline constexpr int kNeighbourPasses = 2;
inline constexpr float kSquaresTolerance = 1e-9f;
inline constexpr double kWorthStep = 0.005;
inline constexpr double kExplained = 1.5;
inline constexpr double kWorthwhile = 0.98;
inline constexpr std::array<double, 8> kTriedRoughnesses = {0.07, 0.10, 0.14, 0.20,
                                                            0.28, 0.39, 0.55, 0.77};
inline constexpr double kOtherRoughness = 0.1;
inline constexpr double kLeastShadingRcond = 1e-6;
// Dampings of the first step. Full Gauss–Newton steps from a rough start throw texels into corners
// that hold them (no specular at all; the smoothest lobe): with a damping of 1e-4 a third of texels
// ended in one, with 1 a twentieth (20 views), in no more steps. Next to a minimum they are what is
// wanted.
inline constexpr float kFarDamping = 1, kNearDamping = 0.01f;
inline constexpr float kStepTolerance = 1e-6f, kExactCost = 1e-14f, kSquaresRounding = 4e-7f;
inline constexpr float kLeastDiagonal = 1e-6f, kLeastDamping = 1e-5f;
inline constexpr double kAlbedoTail = 0.05;
inline constexpr double kLeastRoughness = 0.03, kRoughnessTail = 0.10;
inline constexpr double kMostSlope = 11.43;  // 85° of tilt
inline constexpr double kNearestToBound = 0.01, kFarthestTail = 30.0;
inline constexpr double kLeastAlbedoDeterminant = 1e-6;
inline constexpr double kUnknownInformation = 1e-9, kLeastTexelInformation = 1e-8;
inline constexpr double kLeastViewInformation = 1e-12;
inline constexpr int kLeastFreedom = 6;
inline constexpr double kWidestSd = 1.0;
inline constexpr int kClusteringIterations = 40;
inline constexpr size_t kClusteredTexels = 8192;
inline constexpr int kKindsRounds = 8;
inline constexpr double kMostMeanStep = 0.5, kMostDeviationStep = 0.2, kDeviationStep = 1e-4;
inline constexpr double kLeastViewSd = 1e-6;
inline constexpr int kGlossIterations = 20, kExposureIterations = 12;
inline constexpr size_t kNoiseSamples = 4096;
inline constexpr double kGaussianZeta = 300;
inline constexpr double kThreeTapVariance = 0.5;
inline constexpr int kCorrectionIterations = 25;
inline constexpr double kFirstTolerance = 1e-3, kSecondTolerance = 1e-5, kLastTolerance = 1e-6;
inline constexpr double kFirstViewDamping = 1e-3, kLeastViewDamping = 1e-7, kMostViewDamping = 1e6;
inline constexpr double kViewDampingFall = 0.2, kViewDampingRise = 8;
inline constexpr int kCorrectionMargin_texel = 2;
inline constexpr double kCorrectionNoise = 0.004, kMostTexelStep = 0.3;
inline constexpr int kCorrectionSums = 8;
inline constexpr double kFirstTextureNoise = 0.5;
inline constexpr int kFactorSteps = 10;
inline constexpr int kCoarseSide_px = 256, kCoarseEveryOther = 2, kCoarseMostEachWay = 100;
inline constexpr double kCoarseReach_sd = 3;
inline constexpr int kFarHeights = 5, kFineHeights = 4;
inline constexpr double kFineHeightStep_px = 0.25;
inline constexpr int kCommonRounds = 3, kLeastHeights = 3;
inline constexpr double kStill_px = 0.1;
inline constexpr double kLongestStep_px = 2, kLeastGradient = 1e-3;
inline constexpr int kHeightPasses = 3, kHomographyPasses = 2;
inline constexpr int kAllPairsUpTo = 12, kPeakReach_px = 2;
inline constexpr std::array<int, 5> kPairPartners = {1, 2, 3, 5, 8};
inline constexpr int kDetailLevels = 3;
inline constexpr int kRobustIterations = 30;
inline constexpr double kRobustTolerance = 1e-7;

inline constexpr ModelConstant kSolverRows[] = {
    Row("kSolveIterations", {kSolveIterations}, "steps", "of one solve, at most", "",
        "--iterations"),
    Row("kStarts", {kStarts}, "solves", "per texel, with one from other roughnesses", "",
        "--starts"),
    Row("kNeighbourPasses", {kNeighbourPasses}, "passes", "over neighbours", "",
        "--neighbour-passes"),
    Row("kTriedRoughnesses", {kTriedRoughnesses}, "",
        "from which solves are tried: steps of 1.4, the width of a valley"),
    Row("kExplained, kWorthwhile", {kExplained, kWorthwhile}, "σ²; of the cost",
        "residuals beyond which other initial values are tried, and the cost these must promise"),
    Row("kOtherRoughness, kLeastShadingRcond", {kOtherRoughness, kLeastShadingRcond},
        "log; condition",
        "of a neighbour's roughness, and of lights that tell a normal, to be tried"),
    Row("kSquaresTolerance, kWorthStep", {kSquaresTolerance, kWorthStep}, "log²; σ²",
        "promised gain below which a solve ends: the larger"),
    Row("kFarDamping, kNearDamping", {kFarDamping, kNearDamping}, "of the diagonal",
        "of the first step, far from a minimum and next to one"),
    Row("kStepTolerance, kExactCost, kSquaresRounding",
        {kStepTolerance, kExactCost, kSquaresRounding}, "relative; log²; relative",
        "of single precision: where a solve ends"),
    Row("kLeastDiagonal, kLeastDamping", {kLeastDiagonal, kLeastDamping}, "relative",
        "of the normal equations"),
    Row("kAlbedoTail, kLeastRoughness, kRoughnessTail",
        {kAlbedoTail, kLeastRoughness, kRoughnessTail}, "",
        "least roughness, and widths over which values bend toward their bounds"),
    Row("kMostSlope, kNearestToBound, kFarthestTail", {kMostSlope, kNearestToBound, kFarthestTail},
        "slope; tails; tails",
        "steepest initial normal (85°), nearest to a bound, and where a value is its bound"),
    Row("kLeastAlbedoDeterminant", {kLeastAlbedoDeterminant}, "relative",
        "below which albedos are fitted along the edges"),
    Row("kUnknownInformation, kLeastTexelInformation, kLeastViewInformation",
        {kUnknownInformation, kLeastTexelInformation, kLeastViewInformation}, "",
        "added to normal equations: of sampled texels; of texels eliminated; of views"),
    Row("kWidestSd", {kWidestSd}, "value", "widest standard deviation that is stated"),
    Row("kLeastFreedom", {kLeastFreedom}, "residuals",
        "beyond a texel's values, to count for the channel factor of view correction"),
    Row("kClusteringIterations, kClusteredTexels", {kClusteringIterations, kClusteredTexels},
        "iterations; texels", "of k-means"),
    Row("kKindsRounds", {kKindsRounds}, "rounds", "of kinds and the light's power"),
    Row("kMostMeanStep, kMostDeviationStep, kDeviationStep",
        {kMostMeanStep, kMostDeviationStep, kDeviationStep}, "relative; value; value",
        "longest steps of means and of views' deviations, and that of differences"),
    Row("kLeastViewSd", {kLeastViewSd}, "value", "of views' deviations"),
    Row("kGlossIterations, kExposureIterations", {kGlossIterations, kExposureIterations},
        "iterations", "of the variance of gloss, and of a held-out photograph's best factor"),
    Row("kNoiseSamples, kGaussianZeta", {kNoiseSamples, kGaussianZeta}, "texels per view; δ²/σ²",
        "from which measurement noise is averaged, and where residuals count as Gaussian"),
    Row("kThreeTapVariance", {kThreeTapVariance}, "texels²", "most of one convolution of the blur"),
    Row("kCorrectionIterations", {kCorrectionIterations}, "steps", "of one descent of views"),
    Row("kFirstTolerance, kSecondTolerance, kLastTolerance",
        {kFirstTolerance, kSecondTolerance, kLastTolerance}, "of the cost",
        "gain of a step that ends the three descents"),
    Row("kFirstViewDamping, kLeastViewDamping, kMostViewDamping",
        {kFirstViewDamping, kLeastViewDamping, kMostViewDamping}, "of the diagonal",
        "of the views' steps"),
    Row("kViewDampingFall, kViewDampingRise", {kViewDampingFall, kViewDampingRise}, "factor",
        "on it after a step that is better, or not"),
    Row("kCorrectionMargin_texel, kCorrectionNoise, kMostTexelStep",
        {kCorrectionMargin_texel, kCorrectionNoise, kMostTexelStep}, "texels; log radiance; value",
        "of sampled texels: rim left out, noise that is not searched, longest step after the "
        "views"),
    Row("kCorrectionSums", {kCorrectionSums}, "", "partial sums of the views' equations"),
    Row("kFirstTextureNoise, kFactorSteps", {kFirstTextureNoise, kFactorSteps}, "share; steps",
        "of factor analysis"),
    Row("kCoarseSide_px, kCoarseEveryOther, kCoarseMostEachWay, kCoarseReach_sd",
        {kCoarseSide_px, kCoarseEveryOther, kCoarseMostEachWay, kCoarseReach_sd},
        "pixels; windows; heights; s_h", "of the coarse search for the plane"),
    Row("kFarHeights, kFineHeights, kFineHeightStep_px",
        {kFarHeights, kFineHeights, kFineHeightStep_px}, "heights; heights; pixels",
        "that are tried, each way"),
    Row("kCommonRounds, kLeastHeights, kStill_px", {kCommonRounds, kLeastHeights, kStill_px},
        "rounds; windows; pixels",
        "of plane and homographies in turn: most rounds, least windows, and what counts as no "
        "motion"),
    Row("kLongestStep_px, kLeastGradient", {kLongestStep_px, kLeastGradient}, "pixels; relative",
        "of a window's displacement"),
    Row("kHeightPasses, kHomographyPasses", {kHeightPasses, kHomographyPasses}, "passes",
        "of a robust fit and its scale"),
    Row("kAllPairsUpTo, kPeakReach_px", {kAllPairsUpTo, kPeakReach_px}, "views; pixels",
        "of pairs: all of so few, and about a peak"),
    Row("kPairPartners", {kPairPartners}, "views further on", "of each view of more"),
    Row("kDetailLevels", {kDetailLevels}, "levels", "of the pictures' pyramid"),
    Row("kRobustIterations, kRobustTolerance", {kRobustIterations, kRobustTolerance},
        "iterations; of the cost", "of registration's fits"),
};

}  // namespace glint::constants

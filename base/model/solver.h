// Steps, tolerances and bounds of the solvers: those that can change a map.
#pragma once

#include <array>
#include <cstddef>
#include <numbers>

#include "base/model/model_constant.h"

namespace glint::constants {

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
inline constexpr int kMovesSide_px = 256, kTurnsEachWay = 5, kMoveSweeps = 2, kPartsOfTexture = 4;
inline constexpr int kMostTextures = 3, kTurnSearches = 3;
inline constexpr double kTurnStep_rad = std::numbers::pi / 180, kWellExplained = 0.5;
inline constexpr int kCommonMotionSteps = 10;
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
    Row("kMovesSide_px, kMoveSweeps, kPartsOfTexture",
        {kMovesSide_px, kMoveSweeps, kPartsOfTexture}, "pixels; rounds; a side",
        "of the pictures by which motions of the sample are found; over all photographs; parts in "
        "which its texture is looked for"),
    Row("kMostTextures, kTurnSearches", {kMostTextures, kTurnSearches}, "groups; photographs",
        "of photographs that explain each other, and that may fail before turns are no longer "
        "tried: samples without texture take no time"),
    Row("kTurnsEachWay, kTurnStep_rad, kWellExplained",
        {kTurnsEachWay, kTurnStep_rad, kWellExplained}, "turns; rad; share",
        "that are tried of a photograph of which less is explained; of others one each way"),
    Row("kCommonMotionSteps", {kCommonMotionSteps}, "steps",
        "to what most photographs' shifts have in common"),
    Row("kDetailLevels", {kDetailLevels}, "levels", "of the pictures' pyramid"),
    Row("kRobustIterations, kRobustTolerance", {kRobustIterations, kRobustTolerance},
        "iterations; of the cost", "of registration's fits"),
};

}  // namespace glint::constants

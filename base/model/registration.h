// Where the sample lies and each photograph shows it.
#pragma once

#include <array>

#include "base/model/model_constant.h"

namespace glint::constants {

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
inline constexpr double kLongestMove = 0.1;
inline constexpr double kMoveExplains = 0.8, kLeastExplained = 0.05, kCertainTexture = 0.3;
inline constexpr double kFeignedMove = 1.0 / 512, kLeastFeigned = 0.3, kFeignedHeight = 0.01;
inline constexpr double kMove_sd = 3, kLeastMove = 1.0 / 128;
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
    Row("kLongestMove, kMoveExplains", {kLongestMove, kMoveExplains}, "longer side; share",
        "of a sample that was moved between photographs: longest, and of what no motion leaves of "
        "a photograph's texture the most that may be left",
        "textures repeat themselves"),
    Row("kLeastExplained, kCertainTexture", {kLeastExplained, kCertainTexture}, "share",
        "of a photograph's texture that others explain: less is another texture, and least of "
        "photographs of which that is certain",
        "of another sample 0.00 to 0.05; foil explains itself by 0.05 to 0.3"),
    Row("kFeignedMove, kLeastFeigned, kFeignedHeight",
        {kFeignedMove, kLeastFeigned, kFeignedHeight}, "longer side; factor; longer side",
        "by which shading that moves with the light feigns a motion: times (1 − e)/e of a texture "
        "of which e is explained, at least; and a height",
        "of 55 captures in place all but three lie within 2.1 such deviations, heights up to "
        "0.012"),
    Row("kMove_sd, kLeastMove", {kMove_sd, kLeastMove}, "deviations; longer side",
        "a motion's least; motions that differ by less are one",
        "litter and wood feign 0.006 and 0.003"),
    Row("kLargestImportMargin", {kLargestImportMargin}, "factor",
        "of the sample's size that imported pictures are used to",
        "the sample may lie higher than assumed"),
};

}  // namespace glint::constants

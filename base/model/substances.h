// What tells substances apart, and what is known of them beforehand.
#pragma once

#include <cstddef>

#include "base/model/model_constant.h"

namespace glint::constants {

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
inline constexpr double kReliefSd = 0.1, kErrorsOverStated = 2;
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
    Row("kReliefSd", {kReliefSd}, "θ_n",
        "θ_h of normals about the relief of all texels, which holds what they say already",
        "0.5 and 0.3 leave noise, 0.05 and 0.03 are no better on six real samples"),
    Row("kErrorsOverStated", {kErrorsOverStated}, "factor",
        "on stated errors of slopes; curl beyond is of facets smaller than a texel, "
        "with the variance θ_f²",
        "the curl of fourteen real samples is at most 1.6 times as large; taken as stated, small "
        "stone tiles keep their noise (free .208 for .186)"),
    Row("kNeighbourSd", {kNeighbourSd}, "factor", "θ_b before cross-validation", "a choice"),
};

}  // namespace glint::constants

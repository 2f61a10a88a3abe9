// What specular lobes a sample has (base/reflectance/convention.h): as photographs held out are
// predicted.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/reflectance/convention.h"
#include "fitting/refine/held_out_errors.h"

namespace glint {

// Whether photographs held out, by their errors with each, are predicted so much better by two
// lobes that there are two, although hardly one sample in twenty has a varnish or a polish that
// shows as such (log odds 3).
bool AskForTwoLobes(const HeldOutErrors& two, const HeldOutErrors& one);

// The same of lobes whose tails are shorter than GGX's: about every second sample has them, and
// other programs know GGX alone (log odds 1).
bool AskForShortTails(const HeldOutErrors& short_tails, const HeldOutErrors& ggx);

// The same of lobes that are wider in one direction of the sample: about every fifth sample is of
// wood, cloth or brushed metal, and they are the best of some dozen (log odds 4); where nothing
// tells a direction, cross-validation still reaches 4.4 (log odds 5).
bool AskForAnisotropy(const HeldOutErrors& anisotropic, const HeldOutErrors& isotropic);

// The same of one roughness of all substances, the best of four, in place of those of the greatest
// likelihood (log odds 1).
bool AskForOneRoughness(const HeldOutErrors& one, const HeldOutErrors& as_found);

// The roughness on kRoughnessLevels that predicts best, on the way from the second of them to the
// next that predicts better until none does; nothing: as_found predicts better.
std::optional<double> SearchRoughness(
    const HeldOutErrors& as_found, const std::function<HeldOutErrors(double roughness)>& predict);

// From isotropic lobes on over ln(ratio)·(cos 2φ, sin 2φ), in steps of kAnisotropyStep, to the next
// that predicts better until none does.
Anisotropy SearchAnisotropy(
    const std::function<HeldOutErrors(const Anisotropy& anisotropy)>& predict);

// From one lobe on over a lattice of shares and ratios of roughness, to the next that predicts
// better until none does: once for a narrow lobe that has the specular map's F0, once for a coat's
// of `coat_f0`. Those of the two that ask for two lobes, the better one first; empty: one lobe.
std::vector<SpecularLobes> SearchLobes(
    double coat_f0, const std::function<HeldOutErrors(const SpecularLobes& lobes)>& predict);

}  // namespace glint

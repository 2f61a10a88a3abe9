#include "fitting/refine/refine_metrics.h"

namespace glint {
namespace {

using Summary = RefineSummary;

const ManifestField<Summary> kTexelMetrics[] = {
    {"cost_before", "half the sum of squared residuals of a texel with the initial maps, mean",
     [](const Summary& s) -> Json { return s.start_cost; }},
    {"cost_after", "the same with the refined maps",
     [](const Summary& s) -> Json { return s.final_cost; }},
    {"converged", "share of texels whose solver converged",
     [](const Summary& s) -> Json { return s.converged; }},
    {"from_other_start",
     "share of texels whose solution came from other initial values than those of the initial maps",
     [](const Summary& s) -> Json { return s.other_start; }},
    {"from_neighbour", "share of texels whose solution came from a neighbour's",
     [](const Summary& s) -> Json { return s.neighbour; }},
};

const ManifestField<Summary> kSampleMetrics[] = {
    {"residual_sigma", "scale σ of the log-radiance residuals",
     [](const Summary& s) -> Json { return s.residual_sigma; }},
    {"residual_deviation", "their standard deviation, which long tails raise",
     [](const Summary& s) -> Json { return s.residual_deviation; }},
    {"model_discrepancy", "the part of σ that the reflectance model cannot express",
     [](const Summary& s) -> Json { return s.discrepancy; }},
    {"effective_views", "effective sample size: as many independent views would tell as much",
     [](const Summary& s) -> Json { return s.effective_views; }},
    {"substances", "number of substances", [](const Summary& s) -> Json { return s.substances; }},
    {"narrow_lobe",
     "second specular lobe: `share`, `roughness_ratio`, and `coat_f0` of a coat; null: none",
     [](const Summary& s) -> Json { return JsonOf(s.lobes); }},
    {"anisotropy",
     "of the specular lobes: `ratio` of α along the direction in which they are wider to α across "
     "it, and that `direction_deg`, from the sample's x axis toward its y axis; null: none",
     [](const Summary& s) -> Json { return JsonOf(s.lobes.anisotropy); }},
    {"tail_exponent", "γ of the specular lobes' tails; 2: GGX",
     [](const Summary& s) -> Json { return s.lobes.tail_exponent; }},
    {"one_roughness",
     "that all substances have in the mean, where held-out photographs ask for it; null: each has "
     "its own",
     [](const Summary& s) -> Json {
       return s.one_roughness > 0 ? Json(s.one_roughness) : Json(nullptr);
     }},
    {"roughness_spread",
     "standard deviation of roughness within a substance; null: not estimated from so few "
     "photographs (likewise below)",
     [](const Summary& s) -> Json { return KnownOrNull(s.roughness_spread); }},
    {"specular_spread", "of specular albedo, relative",
     [](const Summary& s) -> Json { return KnownOrNull(s.specular_spread); }},
    {"diffuse_spread", "of diffuse albedo, relative",
     [](const Summary& s) -> Json { return KnownOrNull(s.diffuse_spread); }},
    {"initialisation_error", "errors of the initial maps, in units of those stated",
     [](const Summary& s) -> Json { return s.initialisation_error; }},
    {"neighbour_spread", "how far neighbouring texels differ, in units of the spreads above",
     [](const Summary& s) -> Json { return s.neighbour_spread; }},
    {"normal_spread", "standard deviation θ_n of the normals' x and y",
     [](const Summary& s) -> Json { return KnownOrNull(s.normal_spread); }},
    {"facet_spread", "standard deviation θ_f of slopes that belong to no height field (flakes)",
     [](const Summary& s) -> Json { return s.facet_spread; }},
    {"curve",
     "of the photographs, relative to the one by which they were read: its `toe`, radiance that it "
     "takes off the dark, and `shoulder` (base/reflectance/characteristic_curve.h)",
     [](const Summary& s) -> Json {
       return {{"toe", s.curve.toe}, {"shoulder", s.curve.shoulder}};
     }},
    {"exposure_spread", "standard deviation of the views' log exposures",
     [](const Summary& s) -> Json { return s.exposure_spread; }},
    {"light_spread", "standard deviation of the views' light positions, relative to their distance",
     [](const Summary& s) -> Json { return s.light_spread; }},
};

}  // namespace

std::span<const ManifestField<RefineSummary>> TexelMetrics() { return kTexelMetrics; }

std::span<const ManifestField<RefineSummary>> SampleMetrics() { return kSampleMetrics; }

Json JsonOf(const SpecularLobes& lobes) {
  if (!lobes.two()) return nullptr;
  Json json = {{"share", lobes.narrow_share}, {"roughness_ratio", lobes.narrow_ratio}};
  if (lobes.coat_f0 > 0) json["coat_f0"] = lobes.coat_f0;
  return json;
}

Json JsonOf(const Anisotropy& anisotropy) {
  if (!anisotropy.any()) return nullptr;
  return Json{{"ratio", anisotropy.ratio}, {"direction_deg", anisotropy.direction_deg}};
}

}  // namespace glint

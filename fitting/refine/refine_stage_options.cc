// What glint-refine can be told.
#include "fitting/refine/refine_stage.h"

namespace glint {

void AddRefineOptions(OptionSet* set, RefineStageOptions* options) {
  RefineOptions* refine = &options->refine;
  set->AddRange("iterations", &refine->iterations, 1, 1000,
                "maximum number of Levenberg-Marquardt steps per solve");
  set->AddRange("starts", &refine->starts, 1, 8,
                "solver runs per texel: one from the initial maps, the others from other initial "
                "roughness values; with two or more, also from values that all texels share and "
                "from other initial normals");
  set->AddRange("neighbour-passes", &refine->neighbour_passes, 0, 16,
                "number of times that each texel tries its neighbours' solutions");
  set->AddRange("substances", &refine->substances, 1, kMostSubstances,
                "maximum number of substances (clusters of texels of one material); the texels of "
                "a substance share roughness and albedos");
  set->AddRange("estimation-rounds", &refine->estimation_rounds, 0, 100,
                "number of rounds that estimate variances and substances from sampled texels; run "
                "again once the prior standard deviations are chosen");
  set->AddRange(
      "estimation-size", &refine->estimation_size, 16, 1 << 20,
      "longer side, in texels, of the grid from which texels are drawn for the estimation; "
      "larger maps are uniformly subsampled to this size");
  set->Add("second-lobe", &refine->second_lobe,
           "look for a second, narrow specular lobe of the whole sample (varnish, polish); it is "
           "accepted only if it predicts held-out photographs clearly better, which requires at "
           "least five photographs");
  set->Add("anisotropy", &refine->anisotropy,
           "look for specular lobes of the whole sample that are wider in one direction (wood, "
           "cloth, brushed metal); they are accepted only if they predict held-out photographs "
           "clearly better, which requires at least five photographs");
  set->Add("one-roughness", &refine->one_roughness,
           "also begin from one roughness of all substances under a rough relief (leather, "
           "foam); what follows is accepted only if it predicts held-out photographs better, which "
           "requires at least five photographs; without it refinement takes about three quarters "
           "of the time");
  set->Add("lobe-tails", &refine->lobe_tails,
           "look for specular lobes of the whole sample whose tails are shorter than GGX's "
           "(plastics, print, varnish); they are accepted only if they predict held-out "
           "photographs better, which requires at least five photographs; renderings by Glint then "
           "look more like the sample, but those by programs that support only GGX look less like "
           "it; takes about twice as long");
  set->AddRange("prior", &refine->prior, 0, 1e6, "factor on the weight of the priors; 0: none");
  set->AddRange(
      "point-spread", &refine->point_spread_px, 0, 100,
      "standard deviation of the photographs' point-spread function in pixels (lens, pixel, "
      "demosaicking and resampling together) whose blur was not measured; where texels are finer "
      "than that, renderings of the maps are blurred before they are compared with the "
      "photographs; 0: no blur");
  set->Add(
      "share-detail", &refine->share_detail,
      "give photographs that are blurred more than the others the finer detail that these show, "
      "and let them count for less; not with a fixed camera");
  set->Add(
      "measured-blur", &refine->measured_blur,
      "take each photograph's blur as calibration measured it at the board's corners, where it "
      "did; else --point-spread is that of all photographs");
  set->AddRange(
      "robust-scale", &refine->robust_scale, 1e-3, 100,
      "log-radiance residuals larger than this are penalised linearly instead of quadratically");
  set->AddChoice(
      "correct-views", &options->correction.when, {"auto", "always", "never"},
      "estimate errors in lights, registration and ambient illumination from the photographs; "
      "auto: with five or more distinct views; a correction is applied only where it lowers the "
      "cost by at least 2 %");
  set->AddRange("flash-offset", &options->flash_offset, 0, 1,
                "prior standard deviation of the flash's offset from its stated position, "
                "relative to its distance, if the light was not calibrated; one offset is "
                "estimated for all photographs; 0: none");
  set->AddRange(
      "exposure-spread", &options->exposure_spread, 0, 1,
      "expected standard deviation (a weak prior) of individual photographs' log exposures, if the "
      "light was not calibrated; it and the exposures are then estimated from the "
      "photographs; 0: keep the stated exposures");
  set->AddRange(
      "light-spread", &options->light_spread, 0, 1,
      "expected standard deviation (a weak prior) of each photograph's light position, "
      "perpendicular to the light's direction, relative to its distance, if the light was "
      "not calibrated; it and the positions are then estimated from the photographs; 0: keep "
      "the stated positions");
  set->AddRange(
      "level-spread", &options->level_spread, 0, 10,
      "prior standard deviation of the sample's mean slope, if the camera was fixed and the light "
      "moved; lamps that are brighter on one side look like a tilted sample; 0: none");
  set->AddRange(
      "lamp-gradient", &options->lamp_gradient, 0, 10,
      "prior standard deviation of the gradient of the lamps' log intensities with respect to x "
      "and y of their directions, if the camera was fixed and the light moved; 0: none");
  set->AddRange("residual-sigma", &options->residual_sigma, 1e-3, 10,
                "expected standard deviation (a weak prior) of the log-radiance residuals, if the "
                "light was not calibrated (otherwise 0.05); it is then estimated from the "
                "photographs; it matters most if there are few photographs");
  set->AddRange(
      "flash-beam", &options->flash_beam, 0, 10,
      "prior standard deviation of the slope of the flash's log intensity across its "
      "beam (with respect to the tangent of the angle from its axis), if the light was not "
      "calibrated; one slope is "
      "estimated for all photographs; 0: none");
  set->AddRange(
      "distance-power", &options->distance_power, 0, 10,
      "prior standard deviation of p, where the light's intensity varies as distance^p "
      "(automatic exposure, uncertain distances), if the light was not calibrated; 0: none");
  set->AddRange(
      "toe", &options->toe, 0, 1,
      "prior standard deviation of the toe of the photographs' tone curve: of the radiance (1: "
      "clips) that it takes off the dark, or that stray light adds; one toe is estimated for all "
      "photographs, unless they were stored linear (RAW, float) or the camera was fixed; 0: none");
  set->AddRange(
      "shoulder", &options->shoulder, 0, 1,
      "prior standard deviation of the curve's shoulder s, which makes R·(1 + s)/(1 + s·R) "
      "of a radiance R, likewise, if the light's power is not known and the camera was moved; "
      "0: none");
  set->AddRange("light-power-spread", &options->light_power_spread, 0.01, 10,
                "prior standard deviation of the logarithm of the light's power, if the light was "
                "not calibrated; all specular albedos may be off by this common factor");
  set->AddRange("rows-at-once", &options->rows_at_once, 0, 1 << 20,
                "rows of texels held in memory at once; the result does not depend on it; 0: as "
                "memory allows",
                Invalidates::kNo);
  set->Add("part", &options->part,
           "K/N: refine only the K-th of N parts of the maps, counted from the top, as a separate "
           "job; its result is kept in glint/refine-KofN until --join",
           Invalidates::kNo);
  set->AddRange("join", &options->join, 0, kMostRowParts,
                "join the results of this many parts, made with --part; the result is identical to "
                "a run without parts; 0: refine",
                Invalidates::kNo);
  set->Add("correct-exposures", &options->correction.view.exposure,
           "also let corrections change the photographs' relative exposures");
  set->Add("views", &options->views,
           "views to use, by view name or photograph name (default: those that glint-fit used)");
  set->Add("exclude", &options->exclude, "views to hold out, by view name or photograph name");
  set->Add("from", &options->from, "initial maps, an svbrdf.exr file (default: the fit's)");
}

}  // namespace glint

// What specular lobes a sample has, by cross-validation over its photographs, each with the spreads
// that it asks for.
#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "base/model/estimate.h"
#include "base/reflectance/material_kinds.h"
#include "fitting/refine/lobe_search.h"
#include "fitting/refine/sample_model.h"
#include "fitting/refine/spread_search.h"

namespace glint {

std::vector<SpecularLobes> SampleModel::LobesToTry(const Sampling& sampling) const {
  if (!options_.second_lobe || lobes_.two() || !TellsLobesApart()) return {};
  SampleModel model(*this);
  return SearchLobes(kDielectric.f0 * means_.LightPower(), [&](const SpecularLobes& lobes) {
    model.SetLobes(lobes);
    return model.CrossValidate(sampling);
  });
}

void SampleModel::SetLobes(SpecularLobes lobes) {
  lobes.tail_exponent = lobes_.tail_exponent;
  lobes.anisotropy = lobes_.anisotropy;
  lobes_ = lobes;
}

// Lobes are looked for before spreads, which would make up for the one that is missing, and are
// judged with the spreads that each choice asks for.
SpreadPowers SampleModel::ChooseLobesAndSpreads(const Sampling& sampling,
                                                const SpreadPowers& from) {
  const SampleModel nominal(*this);
  const std::vector<SpecularLobes> to_try = LobesToTry(sampling);
  const SpreadPowers powers = ChooseSpreads(sampling, from);
  const std::optional<HeldOutErrors> one =
      to_try.empty() ? std::nullopt : std::optional(CrossValidate(sampling));
  for (const SpecularLobes& lobes : to_try) {
    SampleModel two(nominal);
    two.SetLobes(lobes);
    two.ChooseSpreads(sampling, powers);
    if (!AskForTwoLobes(two.CrossValidate(sampling), *one)) continue;
    *this = two;
    break;
  }
  return powers;
}

SpreadPowers SampleModel::Choose(const SamplePart* other, const Sampling& sampling,
                                 const Sampling& blocks, const SpreadPowers& from) {
  FreezeViews(constants::kDiffuseSd, sampling);
  ChooseSubstances(other, sampling, blocks);
  return ChooseLobesAndSpreads(blocks, from);
}

bool SampleModel::TellsLobesApart() const {
  return all_views_.size() >= constants::kLeastViewsForOtherLobes;
}

Anisotropy SampleModel::AnisotropyToTry(const Sampling& sampling) const {
  SampleModel model(*this);
  model.SetLobes({});
  return SearchAnisotropy([&](const Anisotropy& anisotropy) {
    model.lobes_.anisotropy = anisotropy;
    return model.CrossValidate(sampling);
  });
}

// Highlights are all that metals show. Under a light of unknown power a wider lobe makes weak
// dielectrics of them, and one roughness is that of neither foil nor of what it is printed on.
bool SampleModel::MayHaveOneRoughness() const {
  return options_.one_roughness && TellsLobesApart() && means_.MetalShare() < 0.5;
}

// Normals' scatter is held too, until it is scaled: by likelihood it would shrink to what a level
// surface of varying albedo leaves of it.
void SampleModel::HoldRoughness(double roughness) {
  for (SharedValues& mean : means_.mean) mean[kSharedRoughness] = roughness;
  means_.holds_roughness = true;
  normal_spreads_.assign(means_.mean.size(), constants::kRoughNormalSd);
}

std::optional<double> SampleModel::RoughnessToTry(const Sampling& sampling,
                                                  const Sampling& blocks) const {
  const HeldOutErrors as_found = CrossValidate(blocks);
  return SearchRoughness(as_found, [&](double roughness) {
    SampleModel model(*this);
    model.SetLobes({});
    model.HoldRoughness(roughness);
    sampling.solver->reflect(model.lobes_);
    Sampling solved = sampling;
    for (int round = 0; round < constants::kOtherSubstanceRounds; ++round) {
      model.Solve({.views = all_views_, .near_minimum = round > 0}, &solved);
      model.UpdateSubstances(solved);
    }
    return model.CrossValidate(blocks);
  });
}

// With all that it asks for: lobes of another shape are rougher or smoother (but where one
// roughness is held), what their tails leave over is another lobe's, and an estimate stays in the
// valley that it is in.
bool SampleModel::TryFrom(const SampleModel& beginning, const Asks& asks, const SamplePart* other,
                          const SpreadPowers& powers, const Sampling& blocks, Sampling* sampling) {
  SampleModel model(beginning);
  Sampling own = model.SamplingOf(sampling->texels, *sampling->solver, sampling->threads);
  model.FitNormalsToo(&own);
  model.Choose(other, own, blocks, powers);
  // Both with the views, and the curve, that the new one found.
  if (asks(model.CrossValidate(blocks), CrossValidate(blocks))) {
    *this = model;
    *sampling = std::move(own);
    return true;
  }
  sampling->solver->deviate(deviations_);
  sampling->solver->weigh(residuals_.variance());
  return false;
}

void SampleModel::ChooseShape(SampleModel beginning, const SamplePart* other,
                              const Sampling& blocks, Sampling* sampling) {
  FreezeViews(constants::kDiffuseSd, *sampling);
  ChooseSubstances(other, *sampling, blocks);
  SampleModel nominal(*this);
  const SpreadPowers powers = ChooseLobesAndSpreads(blocks, {});
  nominal.lobes_ = lobes_;
  std::optional<double> roughness;
  if (nominal.MayHaveOneRoughness()) roughness = nominal.RoughnessToTry(*sampling, blocks);
  if (roughness) {
    SampleModel held(beginning);
    held.HoldRoughness(*roughness);
    if (TryFrom(held, AskForOneRoughness, other, powers, blocks, sampling)) beginning = held;
  }
  SpecularLobes shape;
  if (TellsLobesApart() && options_.anisotropy) shape.anisotropy = AnisotropyToTry(blocks);
  if (shape.anisotropy.any()) {
    beginning.lobes_ = shape;
    TryFrom(beginning, AskForAnisotropy, other, powers, blocks, sampling);
  }
  if (TellsLobesApart() && options_.lobe_tails) {
    beginning.lobes_ = {.tail_exponent = constants::kShortTail, .anisotropy = lobes_.anisotropy};
    TryFrom(beginning, AskForShortTails, other, powers, blocks, sampling);
  }
  sampling->solver->reflect(lobes_);
}

}  // namespace glint

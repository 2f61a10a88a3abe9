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

// From the beginning and with all that it asks for: lobes of another shape are rougher or smoother,
// what their tails leave over is another lobe's, and an estimate stays in the valley that it is in.
void SampleModel::TryShape(const SpecularLobes& shape, const Asks& asks,
                           const SampleModel& pristine, const SamplePart* other,
                           const SpreadPowers& powers, const Sampling& blocks, Sampling* sampling) {
  SampleModel model(pristine);
  model.lobes_ = shape;
  Sampling own = model.SamplingOf(sampling->texels, *sampling->solver, sampling->threads);
  model.FitNormalsToo(&own);
  model.Choose(other, own, blocks, powers);
  // Both with the views, and the curve, that the new shape found.
  if (!asks(model.CrossValidate(blocks), CrossValidate(blocks))) return;
  *this = model;
  *sampling = std::move(own);
}

void SampleModel::ChooseShape(const SampleModel& pristine, const SamplePart* other,
                              const Sampling& blocks, Sampling* sampling) {
  const SpreadPowers powers = Choose(other, *sampling, blocks, {});
  SpecularLobes shape;
  if (TellsLobesApart() && options_.anisotropy) shape.anisotropy = AnisotropyToTry(blocks);
  if (shape.anisotropy.any()) {
    TryShape(shape, AskForAnisotropy, pristine, other, powers, blocks, sampling);
  }
  if (TellsLobesApart() && options_.lobe_tails) {
    shape = {.tail_exponent = constants::kShortTail, .anisotropy = lobes_.anisotropy};
    TryShape(shape, AskForShortTails, pristine, other, powers, blocks, sampling);
  }
  sampling->solver->reflect(lobes_);
  sampling->solver->deviate(deviations_);
}

}  // namespace glint

// The light's power guessed from photographs, as programs guess it where nobody measured it.
// Include from .cc files only: pulls in torch.
#pragma once

#include "fitting/estimator/photograph_features_torch.h"

namespace glint {

// LightGuess (base/linearize/light_guess.h) for a batch on any device, [B, 1, 1, 1, 1]: the
// power that puts the median diffuse albedo at 0.3, or lower where bright texels would pass 0.95.
// Clipped texels count for nothing. Where no texel can be used it is `views`' own.
torch::Tensor GuessedPower(const PhotographTensors& photographs, const ViewTensors& views,
                           const SamplePlane& plane, LightFalloff falloff);

}  // namespace glint

// Weights to start training from: a linear auto-encoder by principal components. Include from .cc
// files only.
//
// Drawn weights spend the first hour of a CPU's training on finding out that detail and normals can
// pass at all (the L1 loss is content with flat ones). So each level starts as the principal
// components of 2×2 blocks of the level below, like a wavelet packet fitted to materials; the outer
// taps of the kernels start at zero. Biases lift the components by kLift standard deviations, where
// LeakyReLU does nothing; training finds out where to bend.
#pragma once

#include "fitting/autoencoder/network.h"

namespace glint {

// `samples`: encoded maps [n, 9, S, S], S a multiple of 32. Without normalisation the code has unit
// variance by the encoder's weights; levels that are normalised (std::invalid_argument) would undo
// the lift.
AutoencoderNetwork StartFromPrincipalComponents(const NetworkChannels& channels,
                                                const torch::Tensor& samples,
                                                Normalisation normalisation = Normalisation::kCode);

}  // namespace glint

// What an auto-encoder can express of a material at all, without photographs in between: the part
// of a fit's error that no photograph and no optimiser takes away.
#pragma once

#include "datasets/evaluation/map_detail.h"
#include "datasets/evaluation/map_error.h"
#include "fitting/autoencoder/autoencoder.h"

namespace glint {

// D(E(truth)).
SvbrdfMaps EncodedAndDecoded(const Autoencoder& network, const SvbrdfMaps& truth, int threads);

// D(z) with z fitted to the true maps themselves: at most `iterations` steps of glint-fit's Adam
// from E(truth) on the L1 of encoded maps, the loss that the network is trained with.
SvbrdfMaps CodeFittedToMaps(const Autoencoder& network, const SvbrdfMaps& truth, int iterations,
                            int threads);

// Maps against the truth.
struct LimitFigures {
  Table1Row errors;
  MapDetail detail;
};
LimitFigures MeasureAgainst(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int threads);

}  // namespace glint

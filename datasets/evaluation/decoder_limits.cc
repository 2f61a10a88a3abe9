#include "datasets/evaluation/decoder_limits.h"

#include <cmath>

#include "fitting/latent/descent.h"

namespace glint {
namespace {

// Mean of |estimate − truth| and its gradient.
double MapLoss(const EncodedMaps& estimate, const EncodedMaps& truth, EncodedMaps* gradient) {
  const double scale = 1.0 / static_cast<double>(truth.planes.size());
  double loss = 0;
  for (size_t i = 0; i < truth.planes.size(); ++i) {
    const float difference = estimate.planes[i] - truth.planes[i];
    loss += std::abs(difference);
    gradient->planes[i] =
        static_cast<float>(difference > 0 ? scale : (difference < 0 ? -scale : 0));
  }
  return loss * scale;
}

}  // namespace

SvbrdfMaps EncodedAndDecoded(const Autoencoder& network, const SvbrdfMaps& truth, int threads) {
  const LatentCode code = network.Encode(truth, threads);
  return DecodeMaps(network.Decode(code, truth.width, truth.height, threads));
}

SvbrdfMaps CodeFittedToMaps(const Autoencoder& network, const SvbrdfMaps& truth, int iterations,
                            int threads) {
  LatentCode code = network.Encode(truth, threads);
  const EncodedMaps target = EncodeMaps(truth);
  Autoencoder::Tape tape(network, true, threads);
  DescentOptions options;
  options.iterations = iterations;
  Descent descent(options, code.values.size());
  EncodedMaps gradient(truth.width, truth.height);
  while (descent.Going()) {
    const double loss = MapLoss(tape.Forward(code, truth.width, truth.height), target, &gradient);
    descent.Step(loss, tape.Backward(gradient), code.values);
  }
  if (!descent.losses().empty()) code.values = descent.best();
  return DecodeMaps(network.Decode(code, truth.width, truth.height, threads));
}

LimitFigures MeasureAgainst(const SvbrdfMaps& estimate, const SvbrdfMaps& truth, int threads) {
  return {EvaluateMaps(estimate, truth, threads), CompareDetail(estimate, truth)};
}

}  // namespace glint
